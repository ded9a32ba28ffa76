#!/usr/bin/env bash
# Sets the machine up, builds, and runs the tests.
#   tests/run.sh [--sanitizers] [--long] [--without KEY,...] [PRESET...]
#     (nothing)     all tests of the release build
#     --sanitizers  in addition: the tests of the libraries of a run (tests/CMakeLists.txt) except
#                   release_only.list under the address and undefined-behaviour sanitizers, and those of them with
#                   several threads in a run under the thread sanitizer
#     --long        all tests under all sanitizers, at full length and with fresh random cases (THIMBLE_SEED=N in the
#                   environment repeats those of N), the release built by clang, a build in which no sources are
#                   joined, the parts that can be left out, then tests on 64-bit ARM under QEMU (hours), clang-tidy,
#                   coverage, mutants, and the additions of the guide's page (about 30 minutes of two cores each)
#     --without     optional parts (keys of app/optional_parts.list) that are not installed and may be absent
#     PRESET        only these
# Exits with 1 if a test fails, or if an optional part that it installs is absent and not named by --without. A test that
# depends on the wall clock (label wall_clock, tests/wall_clock.list) has three attempts, every other test has one.
# Prints the seconds of each stage at the end.
set -euo pipefail
cd "$(dirname "$0")/.."
presets=()
without=${THIMBLE_WITHOUT:-}
usage() {
  sed -n '2,17s/^# \{0,1\}//p' "$0"
  exit 2
}
sanitizers=
while [ $# -gt 0 ]; do
  case $1 in
    --sanitizers) sanitizers=1 ;;
    --long) export THIMBLE_LONG=1 ;;
    --without)
      [ $# -gt 1 ] || usage
      without+=" ${2//,/ }"
      shift
      ;;
    release | dev | clang | asan | asan-all | tsan | tsan-all) presets+=("$1") ;;
    *) usage ;;
  esac
  shift
done
export THIMBLE_WITHOUT=$without
app/optional_parts.sh keys >/dev/null || exit 2  # a key that does not exist
# The long form draws new random cases: one number for all of its tests (tests/support/seed.h).
[ -z "${THIMBLE_LONG:-}" ] || export THIMBLE_SEED="${THIMBLE_SEED:-$(od -An -N4 -tu4 /dev/urandom | tr -d ' ')}"
more=()
if [ ${#presets[@]} = 0 ]; then
  presets=(release)
  if [ -n "${THIMBLE_LONG:-}" ]; then
    presets+=(asan-all tsan-all)
    more=(core arm64 tidy coverage mutate extending)
  elif [ -n "$sanitizers" ]; then
    presets+=(asan tsan)
  fi
fi

stages=()
stage_begin=$SECONDS
end_stage() {  # end_stage NAME: notes the seconds since the end of the last stage
  stages+=("$(printf '%5d s  %s' $((SECONDS - stage_begin)) "$1")")
  stage_begin=$SECONDS
}

# Everything is installed before configuration. Parts that cannot be installed are named here and fail at the end.
promised=(base program all tests ${THIMBLE_LONG:+long})
app/optional_parts.sh install "${promised[@]}" || true
[[ " $without " == *" usb "* ]] || tests/usb/setup.sh || true
end_stage "installation"
if [ ${#more[@]} -gt 0 ] && command -v clang++ >/dev/null; then presets+=(clang); fi

# Prints the output of failed tests at the very end, because CI logs are often cut to their last lines.
report_failures() {  # report_failures PRESET
  local name
  [ -s "build/$1.failed" ] || return 0  # it did not build, or is no preset
  while IFS= read -r name; do
    echo "== $1: $name"
    awk -v name="$name" '/^[0-9]+\/[0-9]+ Testing: / { inside = $0 ~ / Testing: / && substr($0, index($0, " Testing: ") + 10) == name } inside' \
      "build/$1.details" | tail -n 40
  done <"build/$1.failed"
  sed "s/^/Failed in $1: /" "build/$1.failed"
}

# In the short form a sanitizer preset builds only the tests of libraries (tests/CMakeLists.txt).
build() {  # build PRESET
  case $1 in
    asan | tsan) app/setup.sh "$1" tests ;;
    *) app/setup.sh "$1" ;;
  esac
}

# Runs the tests of a preset. Failed tests that depend on the wall clock, which a busy machine makes fail, are
# repeated one at a time. Writes to build/: PRESET.tests (output), PRESET.failed and PRESET.retried (names),
# PRESET.details (output of each test, if one failed).
run_tests() {  # run_tests PRESET CTEST_ARGUMENT...
  local preset=$1 logs=build/$1/Testing/Temporary files=build/$1 attempt pattern
  shift
  rm -f "$logs/LastTestsFailed.log" "$files.details"
  : >"$files.failed"
  : >"$files.retried"
  ! ctest --preset "$preset" "$@" | tee "$files.tests" || return 0
  [ -f "$logs/LastTestsFailed.log" ] || return 1
  cut -d: -f2- "$logs/LastTestsFailed.log" >"$files.failed"
  cp "$logs/LastTest.log" "$files.details"
  ctest --preset "$preset" -N -L '^wall_clock$' | sed -n 's/^ *Test *#[0-9]*: //p' >"$files.wall_clock"
  for attempt in 2 3; do
    grep -xF -f "$files.wall_clock" "$files.failed" >"$files.again" || break
    echo "== Attempt $attempt of tests that depend on the wall clock: $preset"
    pattern=$(sed 's/[].*+?^$()|\\[]/\\&/g' "$files.again" | paste -s -d '|')
    ctest --preset "$preset" --parallel 1 --fixture-exclude-any . -R "^($pattern)\$" >"$files.output" || true
    cat "$files.output"
    cat "$logs/LastTest.log" >>"$files.details"
    sed -nE 's/^.*Test +#[0-9]+: ([^ ]+) .* Passed +[0-9].*/\1/p' "$files.output" | tee -a "$files.retried" >"$files.passed"
    grep -vxF -f "$files.passed" "$files.failed" >"$files.rest" || true
    mv "$files.rest" "$files.failed"
  done
  [ ! -s "$files.failed" ]
}

failed=()
for preset in "${presets[@]}"; do
  leave=()
  case $preset in
    asan | tsan) leave=(-L .) ;; # tests of sources, not of programs, ran with the release
  esac
  build "$preset"
  end_stage "build $preset"
  for key in $(app/optional_parts.sh missing "build/$preset" "${promised[@]}"); do
    echo "NOTE: the optional part $key is absent, so $preset fails in the end (--without $key accepts that)." >&2
  done
  echo "== Tests: $preset"
  run_tests "$preset" "${leave[@]}" || failed+=("$preset")
  end_stage "tests $preset"
done
[ ${#more[@]} = 0 ] || app/setup.sh dev || failed+=(dev)  # each source with its own includes
for name in "${more[@]}"; do
  echo "== $name"
  all=()
  [ "$name" != arm64 ] || all=(--all)
  env -u THIMBLE_LONG -u THIMBLE_SEED "tests/$name.sh" "${all[@]}" || [ $? = 3 ] || failed+=("$name")  # 3: not installed
  end_stage "$name"
done
echo "Stages, in seconds:"
printf '  %s\n' "${stages[@]}"
# Repeats at the end which tests did not run, or passed only at a further attempt.
for preset in "${presets[@]}"; do
  sed "s/^/Passed at a further attempt in $preset: /" "build/$preset.retried"
  sed -n "s/.*Test  *#[0-9]*: \([^ ]*\) .*\*\*\*Skipped.*/Not tested in $preset: \1/p" "build/$preset.tests" || true
done
app/optional_parts.sh table "build/${presets[0]}" "${promised[@]}"
status=0
[ -z "${THIMBLE_SEED:-}" ] || echo "Random cases: THIMBLE_SEED=$THIMBLE_SEED repeats them, of all tests or one: CONTRIBUTING.md"
if [ ${#failed[@]} -gt 0 ]; then
  for preset in "${failed[@]}"; do report_failures "$preset" >&2; done
  echo "Tests failed in: ${failed[*]}" >&2
  status=1
fi
for preset in "${presets[@]}"; do
  for key in $(app/optional_parts.sh missing "build/$preset" "${promised[@]}"); do
    echo "Absent in $preset: $key. Install it as the table above says, or accept it: tests/run.sh --without $key" >&2
    status=1
  done
done
exit $status
