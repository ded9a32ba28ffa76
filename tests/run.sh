#!/usr/bin/env bash
# Runs every test: sets the machine up, builds, and runs the tests as release, under the address and
# undefined-behaviour sanitizers, and those in which threads meet under the thread sanitizer.
#   tests/run.sh [--long] [PRESET...]    --long: all tests under all sanitizers, at full length;
#                                        PRESET: only these
set -euo pipefail
cd "$(dirname "$0")/.."
presets=()
for argument in "$@"; do
  case $argument in
    --long) export THIMBLE_LONG=1 ;;
    release | dev | asan | tsan | tsan-all) presets+=("$argument") ;;
    *)
      sed -n '2,5s/^# \{0,1\}//p' "$0"
      exit 2
      ;;
  esac
done
[ ${#presets[@]} -gt 0 ] || presets=(release asan "tsan${THIMBLE_LONG:+-all}")

tests/usb/setup.sh || true  # optional: without it the USB arms are not tested through a kernel
tests/fuzz/setup.sh || true  # optional: without it only the corpora are replayed

failed=()
for preset in "${presets[@]}"; do
  app/setup.sh "$preset"
  echo "== Tests: $preset"
  ctest --preset "$preset" || failed+=("$preset")
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "Tests failed in: ${failed[*]}" >&2
  exit 1
fi
