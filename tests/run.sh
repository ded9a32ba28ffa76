#!/usr/bin/env bash
# Runs every test: sets the machine up, builds, and runs all tests as release, those of the libraries of a run
# (tests/CMakeLists.txt) but for release_only.list under the address and undefined-behaviour sanitizers, and of these
# the ones in which threads of a run meet under the thread sanitizer.
#   tests/run.sh [--long] [PRESET...]    --long: all tests under all sanitizers, at full length, the
#                                        release built by clang, a build in which no sources are
#                                        joined, then tests on 64-bit ARM under QEMU (hours),
#                                        clang-tidy, coverage and mutants (40, 30 and 30 minutes of
#                                        two cores), if what they need is installed;
#                                        PRESET: only these
set -euo pipefail
cd "$(dirname "$0")/.."
presets=()
for argument in "$@"; do
  case $argument in
    --long) export THIMBLE_LONG=1 ;;
    release | dev | clang | asan | asan-all | tsan | tsan-all) presets+=("$argument") ;;
    *)
      sed -n '2,10s/^# \{0,1\}//p' "$0"
      exit 2
      ;;
  esac
done
more=()
if [ ${#presets[@]} = 0 ]; then
  presets=(release "asan${THIMBLE_LONG:+-all}" "tsan${THIMBLE_LONG:+-all}")
  if [ -n "${THIMBLE_LONG:-}" ]; then
    more=(arm64 tidy coverage mutate)
    if tests/optional_packages.sh "the build by clang" clang; then presets+=(clang); fi
  fi
fi

tests/usb/setup.sh || true  # optional: without it the USB arms are not tested through a kernel
tests/fuzz/setup.sh || true  # optional: without it only the corpora are replayed
[ -z "${THIMBLE_LONG:-}" ] || tests/faces/setup.sh || true  # optional: 64-bit ARM
[ -z "${THIMBLE_LONG:-}" ] || tests/optional_packages.sh "packages and image in a bare Debian 12" debootstrap buildah || true
tests/optional_packages.sh "the window on a screen in memory" xvfb xdotool || true
tests/optional_packages.sh "sines and exponentials against their true values" libmpfr-dev || true
tests/optional_packages.sh "the guide as web pages" mkdocs || true
tests/optional_packages.sh "the format of the sources" clang-format-14 || true
tests/optional_packages.sh "pictures, tables and compiled laws of the Python package" \
  python3-matplotlib python3-pandas python3-numba || true
[ -z "${THIMBLE_LONG:-}" ] || tests/optional_packages.sh "its notebooks in Jupyter, its types" \
  python3-nbclient python3-ipykernel mypy || true
tests/optional_packages.sh "animations as MP4 and GIF" ffmpeg || true
tests/optional_packages.sh "the page in a real browser" chromium python3-websockets || true

# What failed, again at the very end: a log of CI is often cut to its last lines.
tell_failures() {  # tell_failures PRESET
  local logs=build/$1/Testing/Temporary
  [ -e "$logs/LastTestsFailed.log" ] || return 0  # it did not build, or is no preset
  cut -d: -f2- "$logs/LastTestsFailed.log" | while IFS= read -r name; do
    echo "== $1: $name"
    awk -v name="$name" '/^[0-9]+\/[0-9]+ Testing: / { inside = index($0, " Testing: " name) > 0 } inside' \
      "$logs/LastTest.log" | tail -n 40
  done
  cut -d: -f2- "$logs/LastTestsFailed.log" | sed "s/^/Failed in $1: /"
}

# A sanitizer builds no more than the tests of libraries (tests/CMakeLists.txt) in its short form.
build() {  # build PRESET
  case $1 in
    asan | tsan) app/setup.sh "$1" tests ;;
    *) app/setup.sh "$1" ;;
  esac
}

failed=()
for preset in "${presets[@]}"; do
  leave=()
  case $preset in
    asan | tsan) leave=(-L .) ;; # what lies in sources, and not in a program, was tested with the release
  esac
  build "$preset"
  echo "== Tests: $preset"
  # Tests by the wall clock fail where the machine stands still for longer than an arm's watchdog allows; what fails by
  # itself fails each time. Those that passed at a further try are named below.
  ctest --preset "$preset" --repeat until-pass:3 "${leave[@]}" | tee "build/$preset.tests" || failed+=("$preset")
done
[ ${#more[@]} = 0 ] || app/setup.sh dev || failed+=(dev)  # each source with its own includes
for name in "${more[@]}"; do
  echo "== $name"
  all=()
  [ "$name" != arm64 ] || all=(--all)
  env -u THIMBLE_LONG "tests/$name.sh" "${all[@]}" || [ $? = 3 ] || failed+=("$name")  # 3: not installed
done
# What was not tested, or not at the first try, once more where it is seen.
for preset in "${presets[@]}"; do
  sed -nE 's/.*Test +#[0-9]+: ([^ ]+) .*\*\*\*(Failed|Timeout|Exception).*/\1/p' "build/$preset.tests" 2>/dev/null | sort -u |
    { grep -vxF -f <(cut -d: -f2- "build/$preset/Testing/Temporary/LastTestsFailed.log" 2>/dev/null) || true; } |
    sed "s/^/Passed at a further try in $preset: /" || true
  sed -n "s/.*Test  *#[0-9]*: \([^ ]*\) .*\*\*\*Skipped.*/Not tested in $preset: \1/p" "build/$preset.tests" 2>/dev/null || true
done
if [ ${#failed[@]} -gt 0 ]; then
  for preset in "${failed[@]}"; do tell_failures "$preset" >&2; done
  echo "Tests failed in: ${failed[*]}" >&2
  exit 1
fi
