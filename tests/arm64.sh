#!/usr/bin/env bash
# Builds tests for 64-bit ARM and runs them by QEMU, with the hashes that x86-64 stored. Emulated: no board was asked.
#   tests/arm64.sh [PROGRAM...]    PROGRAM: of the tests, such as test_packed; without one test_math, which is quick
# Ends with 3 where the cross compiler or QEMU is not installed.
set -euo pipefail
cd "$(dirname "$0")/.."
for tool in aarch64-linux-gnu-g++ qemu-aarch64; do
  command -v $tool >/dev/null || {
    echo "SKIPPED: nothing was tested on 64-bit ARM: $tool is missing (as root: tests/faces/setup.sh)" >&2
    exit 3
  }
done
programs=("${@:-test_math}")
tests/arm64_sysroot.sh build/arm64_sysroot
cmake --preset arm64 >build/arm64.log 2>&1 || {
  tail -n 20 build/arm64.log >&2
  exit 1
}
cmake --build --preset arm64 --target "${programs[@]}"

failed=()
for program in "${programs[@]}"; do
  path=$(find build/arm64/tests -type f -name "$program" -perm -u+x)
  echo "== $program on 64-bit ARM"
  qemu-aarch64 -L build/arm64_sysroot "$path" --gtest_brief=1 || failed+=("$program")
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "FAILED on 64-bit ARM: ${failed[*]}" >&2
  exit 1
fi
