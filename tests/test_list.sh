#!/usr/bin/env bash
# Fails if a line of a list of tests names no test of a build, or names one without the label, or if no line names a test
# with the label.
#   tests/test_list.sh BUILD_FOLDER LIST
#   tests/test_list.sh BUILD_FOLDER LIST LABEL
set -euo pipefail
list=$(dirname "$0")/$2
# Runs in a separate folder, because a ctest that lists tests truncates the log of one that runs them.
lister=$(mktemp -d)
trap 'rm -rf "$lister"' EXIT
echo "subdirs(\"$(realpath "$1")\")" >"$lister/CTestTestfile.cmake"
names() { ctest --test-dir "$lister" -N "$@" | sed -n 's/^ *Test *#[0-9]*: //p'; }
tests=$(names)
labelled=${3:+$(names -L "^$3\$")}
bad=0
named=$lister/named
: >"$named"
while IFS=' #' read -r pattern part; do
  if [ -n "$part" ] && ! grep -q "^on|$part|" "$1/optional_parts.txt"; then continue; fi
  found=
  while IFS= read -r name; do
    # shellcheck disable=SC2254
    case $name in
      $pattern)
        found=yes
        echo "$name" >>"$named"
        ;;
    esac
  done <<<"$tests"
  [ -n "$found" ] || { echo "$list: no test is named $pattern" && bad=1; }
done < <(grep '^[^#]' "$list")
if [ -n "${3:-}" ]; then
  while IFS= read -r line; do
    echo "$list and the label $3 do not agree: $line" && bad=1
  done < <(diff <(sort -u "$named") <(sort -u <<<"$labelled") | grep '^[<>]' || true)
fi
exit $bad
