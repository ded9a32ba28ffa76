#!/usr/bin/env bash
# Tests the mutation tool on a small project (sample): which mutants are killed, which survive, which hang
# or do not compile, and that its exit code shows whether enough are killed.
set -euo pipefail
[ -n "${THIMBLE_LONG:-}" ] || { echo "SKIPPED: the mutants' tool is tried in the long form, which runs it." && exit 77; }
for tool in python3 git ninja; do command -v "$tool" >/dev/null || exit 77; done
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
cp -r "$here/sample" "$scratch/sample"
cp "$here/mutant.h" "$scratch/sample/"
cd "$scratch/sample"
git init -q .
sources=$(cat counting/* | cksum)

run() {
  code=0
  python3 -B "$here/mutate.py" --root "$scratch/sample" --plan plan.json --work "$scratch/work" \
    --table "$scratch/table.md" "$@" >"$scratch/log" 2>&1 || code=$?
}
fail() {
  echo "$1" >&2
  cat "$scratch/log" >&2
  exit 1
}
has() { grep -qF -- "$1" "$2" || fail "Not told: $1"; }
ends() { grep -A2 -F "$1" "$scratch/log" | grep -qF -- "+ $2" || fail "Not told: $1 + $2"; }

run
[ $code = 1 ] || fail "Survivors end with $code in place of 1."
ends "negated: fails (Counting.StaysBelowTheMost)" 'if (!(x > most)) return most;'
ends "removed: hangs" 'while (i < n) ;'
ends "operator: SURVIVED (survived)" 'return x - x;'
ends "operator: SURVIVED (unreached)" 'return x - 2;'
has "1 do not compile" "$scratch/log"
has '`return x + x;` -> `return x - x;` | operator | not looked at yet |' "$scratch/table.md"
grep -qE '\| counting \| [1-9][0-9]* \| 4 \| 0 \|' "$scratch/table.md" || fail "Wrongly counted."
[ "$(cat counting/* | cksum)" = "$sources" ] || fail "The sources are changed."

# An equivalent mutant does not count and its reason is kept; with a new test enough mutants are killed.
sed -i '/x >= most/s/not looked at yet/equivalent: both are the most/' "$scratch/table.md"
sed -i 's/^  doubled(2);/  EXPECT_EQ(doubled(2) + tripled(5), 11);/' counting_test.cpp
run --survivors
[ $code = 0 ] || fail "Where all are killed it ends with $code."
has "0 survived, 1 equivalent: 100.0 %" "$scratch/log"
has "equivalent: both are the most" "$scratch/table.md"

# Without a mutant every test must pass; a single line can be tested.
run --again counting/counting.cpp:5
[ $code = 0 ] || fail "One line alone ends with $code."
sed -i 's/at_most(3, 5), 3/at_most(3, 5), 4/' counting_test.cpp
run
[ $code = 1 ] || fail "A test that fails without mutants ends with $code."
has "fails in Counting.StaysBelowTheMost without any mutant" "$scratch/log"
echo "The mutants' tool tells what it must."
