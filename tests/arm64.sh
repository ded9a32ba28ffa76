#!/usr/bin/env bash
# Builds tests for 64-bit ARM and runs them under QEMU with the hashes stored on x86-64. Not run on a real board.
#   tests/arm64.sh [--all | PROGRAM...]    PROGRAM: a test program such as test_packed; by default test_math, which
#                                          is quick; --all: those of driver, device_sim, render and tests/sim, hours
# Exits with 3 if the cross compiler or QEMU is not installed.
set -euo pipefail
cd "$(dirname "$0")/.."
for tool in aarch64-linux-gnu-g++ qemu-aarch64; do
  command -v $tool >/dev/null || {
    echo "SKIPPED: nothing was tested on 64-bit ARM: $tool is missing (as root: tests/compat/setup.sh)" >&2
    exit 3
  }
done
tests/arm64_sysroot.sh build/arm64_sysroot
cmake --preset arm64 >build/arm64.log 2>&1 || {
  tail -n 20 build/arm64.log >&2
  exit 1
}
if [ "${1:-}" = --all ]; then
  cmake --build --preset arm64 --parallel "$(nproc)" --target tests_driver tests_device_sim tests_render tests_sim
  mapfile -t paths < <(find build/arm64/tests/unit/{driver,device_sim,render} build/arm64/tests/sim \
    -type f -name 'test_*' -perm -u+x | sort)
else
  programs=("${@:-test_math}")
  cmake --build --preset arm64 --parallel "$(nproc)" --target "${programs[@]}"
  mapfile -t paths < <(for program in "${programs[@]}"; do
    find build/arm64/tests -type f -name "$program" -perm -u+x
  done)
fi

# Each in a separate process, one per core at a time. Three tests are excluded. One asks the kernel for the name of
# a program and sees QEMU. In another, a message of 1 MB takes QEMU longer than a service may be silent. The third
# sets a limit of memory, which does not apply to the emulated program.
run_emulated() {  # run_emulated PATH
  qemu-aarch64 -L build/arm64_sysroot "$1" --gtest_brief=1 '--gtest_filter=-NodeLock.NamesTheProgramThat*:HaplyLinkTest.NamesEachFault*:RunInSandbox.SurvivesWork*' >"$1.log" 2>&1 || touch "$1.failed"
}
export -f run_emulated
rm -f "${paths[@]/%/.failed}"
printf '%s\0' "${paths[@]}" | xargs -0 -n 1 -P "$(nproc)" bash -c 'run_emulated "$0"'
failed=()
for path in "${paths[@]}"; do
  echo "== $(basename "$path") on 64-bit ARM"
  cat "$path.log"
  [ ! -e "$path.failed" ] || failed+=("$(basename "$path")")
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "FAILED on 64-bit ARM: ${failed[*]}" >&2
  exit 1
fi
