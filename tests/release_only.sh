#!/usr/bin/env bash
# Prints the tests of release_only.list as one expression for `ctest -E`.
#   tests/release_only.sh [BUILD_FOLDER]     with a folder: fails if a line names no test of that build
set -euo pipefail
list=$(dirname "$0")/release_only.list
names=$(grep -v '^#' "$list")
if [ -n "${1:-}" ]; then
  tests=$(ctest --test-dir "$1" -N | sed -n 's/^ *Test *#[0-9]*: //p')
  bad=0
  while read -r name; do
    grep -qE "$name" <<<"$tests" || { echo "$list: no test is named $name" && bad=1; }
  done <<<"$names"
  exit $bad
fi
paste -sd'|' <<<"$names"
