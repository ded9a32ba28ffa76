#!/usr/bin/env bash
# Fails if a line of release_only.list names no test of a build.
#   tests/release_only.sh BUILD_FOLDER
set -euo pipefail
list=$(dirname "$0")/release_only.list
# By a folder of its own, for a ctest that lists tests takes the log from the one that runs them.
lister=$(mktemp -d)
trap 'rm -rf "$lister"' EXIT
echo "subdirs(\"$(realpath "$1")\")" >"$lister/CTestTestfile.cmake"
tests=$(ctest --test-dir "$lister" -N | sed -n 's/^ *Test *#[0-9]*: //p')
bad=0
while IFS= read -r pattern; do
  found=
  while IFS= read -r name; do
    case $name in $pattern) found=yes && break ;; esac
  done <<<"$tests"
  [ -n "$found" ] || { echo "$list: no test is named $pattern" && bad=1; }
done < <(grep -v '^#' "$list")
exit $bad
