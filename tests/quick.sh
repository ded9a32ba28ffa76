#!/usr/bin/env bash
# Builds the unit tests of one module in preset dev after a change, and runs them, each program in one process. Leaves out the
# tests that take long (tests/long.list) and those that depend on the wall clock; ctest and tests/run.sh run all.
#   tests/quick.sh MODULE    MODULE: driver, device_sim, render, app, view
set -euo pipefail
cd "$(dirname "$0")/.."
module=${1:-}
if [ $# -ne 1 ] || [ ! -d "tests/unit/$module" ] || [ -z "$module" ]; then
  sed -n '2,4s/^# \{0,1\}//p' "$0" >&2
  exit 2
fi
[ -e build/dev/build.ninja ] || app/setup.sh dev "tests_$module"
cmake --build --preset dev --target "tests_$module"
filter=$(sed -n 's/ *#.*//; /^[A-Z]/p' tests/long.list tests/wall_clock.list | paste -sd:)
# The largest programs first, so that no processor waits for the last one.
ls -S -1 "build/dev/tests/unit/$module/"test_* | while read -r program; do
  if [ -f "$program" ] && [ -x "$program" ]; then echo "$program"; fi
done | xargs -P "$(nproc)" -I{} sh -c '"$1" --gtest_brief=1 --gtest_filter="-$2" || { echo "$1 failed." >&2; exit 1; }' _ {} "$filter"
