#!/usr/bin/env bash
# Shows that hard_cases.sh --check fails for invented wrong lines of every case.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Writes good lines; an argument "number|figure" replaces that case's figure, "-" omits it.
lines() {
  awk -F'|' -v change="${1:-}" '
    BEGIN { split(change, c, "|") }
    /^[#=]/ { next }
    { sub(/[?]$/, "", $1); figure = $1 == c[1] ? c[2] : "1"
      if (figure == "-") next
      print "HARD_CASE|" $1 "|words|<= something|" figure "|2|N|" $4 ".Test|tests/a_test.cpp" }
  ' "$here/hard_cases.list" >"$scratch/lines/all"
}
check() { bash "$here/hard_cases.sh" --check "$scratch/lines" >"$scratch/log" 2>&1; }
must_fail() {
  if check; then
    echo "hard_cases.sh --check did not notice $1" >&2
    exit 1
  fi
  grep -q "$2" "$scratch/log" || { echo "Not reported: $1" >&2; cat "$scratch/log" >&2; exit 1; }
}

mkdir "$scratch/lines"
export THIMBLE_LONG=1  # lines that differ from the table
lines && check || { cat "$scratch/log" >&2; exit 1; }
lines '7|-' && must_fail "a case without figure" "case 7 has no figure"
lines '7|2.1' && must_fail "a figure beyond its limit" "case 7, words: 2.1 is not ≤ 2"
lines '7|nan' && must_fail "a figure that is not a number" "case 7, words: nan is not"
lines '7|inf' && must_fail "an infinite figure" "case 7, words: inf is not"
lines && echo "HARD_CASE|99|w|<= s|1|2|N|T.T|f" >>"$scratch/lines/all"
must_fail "a case that is not in the list" "case 99 is not in"
lines && echo "HARD_CASE|1|words|<= s|1|2|N|HardCaseJitter.Test|f" >>"$scratch/lines/all"
must_fail "a test in the suite of another case" "case 1 has the suite HardCaseStiffestWall, not that of HardCaseJitter"
lines && echo "HARD_CASE|1|torn" >>"$scratch/lines/all"
must_fail "a torn line" "a malformed line"
# Rows like cases 4 and 38: above a limit, and equal to it.
lines && echo "HARD_CASE|4|adversary|> gain|-0.49|0|1|HardCaseEncoderAdversary.Test|f" >>"$scratch/lines/all"
must_fail "an adversary who gains nothing" "case 4, adversary: -0.49 is not > 0"
lines && echo "HARD_CASE|38|glitches|== not dropped|1|0|1|HardCaseEncoderFault.Test|f" >>"$scratch/lines/all"
must_fail "a glitch that was not dropped" "case 38, glitches: 1 is not = 0"
unset THIMBLE_LONG
lines && must_fail "an old table" "differs from the measurements"
rm -r "$scratch/lines" && must_fail "a run without output" "case 1 has no figure"
echo "hard_cases.sh --check reports all invented errors."
