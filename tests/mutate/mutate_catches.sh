#!/usr/bin/env bash
# Tests the mutation tool on a small project (sample): which mutants are killed, which survive, which hang
# or do not compile, and that its exit code shows whether enough are killed.
set -euo pipefail
[ -n "${THIMBLE_LONG:-}" ] || { echo "SKIPPED: the mutation tool is tested in the long form only." && exit 77; }
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
has() { grep -qF -- "$1" "$2" || fail "Not printed: $1"; }
ends() { grep -A2 -F "$1" "$scratch/log" | grep -qF -- "+ $2" || fail "Not printed: $1 + $2"; }

run
[ $code = 1 ] || fail "With survivors the exit code is $code instead of 1."
ends "negated: fails (Counting.StaysWithinTheBound)" 'if (!(x > max)) return max;'
ends "removed: hangs" 'while (i < n) ;'
ends "operator: SURVIVED (survived)" 'return x - x;'
ends "operator: SURVIVED (unreached)" 'return x - 2;'
has "1 do not compile" "$scratch/log"
has '`return x + x;` -> `return x - x;` | operator | not analysed yet |' "$scratch/table.md"
grep -qE '\| counting \| [1-9][0-9]* \| 4 \| 0 \|' "$scratch/table.md" || fail "The counts of the table are wrong."
[ "$(cat counting/* | cksum)" = "$sources" ] || fail "The sources were changed."

# An equivalent mutant does not count and its reason is kept; with a new test enough mutants are killed.
sed -i '/x >= max/s/not analysed yet/equivalent: both are equal/' "$scratch/table.md"
sed -i 's/^  doubled(2);/  EXPECT_EQ(doubled(2) + tripled(5), 11);/' counting_test.cpp
run --survivors
[ $code = 0 ] || fail "With all killed the exit code is $code."
has "0 survived, 1 equivalent: 100.0 %" "$scratch/log"
has "equivalent: both are equal" "$scratch/table.md"

# Without a mutant every test must pass; a single line can be tested.
run --again counting/counting.cpp:5
[ $code = 0 ] || fail "For a single line the exit code is $code."
sed -i 's/limited(3, 5), 3/limited(3, 5), 4/' counting_test.cpp
run
[ $code = 1 ] || fail "For a test that fails without mutants the exit code is $code."
has "fails in Counting.StaysWithinTheBound without any mutant" "$scratch/log"
echo "The mutation tool passes."
