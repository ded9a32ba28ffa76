#!/usr/bin/env bash
# Runs every test: sets the machine up, builds, and runs the tests as release, under the address and
# undefined-behaviour sanitizers, and those in which threads meet under the thread sanitizer.
#   tests/run.sh [--long] [PRESET...]    --long: all tests under all sanitizers, at full length, then
#                                        clang-tidy, coverage and mutants (40, 30 and 30 minutes of
#                                        two cores), if what they need is installed;
#                                        PRESET: only these
set -euo pipefail
cd "$(dirname "$0")/.."
presets=()
for argument in "$@"; do
  case $argument in
    --long) export THIMBLE_LONG=1 ;;
    release | dev | asan | tsan | tsan-all) presets+=("$argument") ;;
    *)
      sed -n '2,7s/^# \{0,1\}//p' "$0"
      exit 2
      ;;
  esac
done
more=()
if [ ${#presets[@]} = 0 ]; then
  presets=(release asan "tsan${THIMBLE_LONG:+-all}")
  [ -z "${THIMBLE_LONG:-}" ] || more=(tidy coverage mutate)
fi

tests/usb/setup.sh || true  # optional: without it the USB arms are not tested through a kernel
tests/fuzz/setup.sh || true  # optional: without it only the corpora are replayed
tests/optional_packages.sh "the guide as web pages" mkdocs || true
tests/optional_packages.sh "the format of the sources" clang-format-14 || true

failed=()
for preset in "${presets[@]}"; do
  app/setup.sh "$preset"
  echo "== Tests: $preset"
  ctest --preset "$preset" || failed+=("$preset")
done
for name in "${more[@]}"; do
  echo "== $name"
  env -u THIMBLE_LONG "tests/$name.sh" || [ $? = 3 ] || failed+=("$name")  # 3: not installed
done
if [ ${#failed[@]} -gt 0 ]; then
  echo "Tests failed in: ${failed[*]}" >&2
  exit 1
fi
