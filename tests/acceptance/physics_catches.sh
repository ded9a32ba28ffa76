#!/usr/bin/env bash
# Shows that physics.sh --check fails for invented wrong lines.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
export THIMBLE_PHYSICS_PAGE=$scratch/page.md
mkdir "$scratch/lines"

line() { echo "PHYSICS|body|fall|-g t^2 / 2|m|-1.2|${1:--1.2}|${2:-1e-4}|${3:-1e-3}|PhysicsOfA.Test|tests/a_test.cpp"; }
check() { bash "$here/physics.sh" --check "$scratch/lines" >"$scratch/log" 2>&1; }
must_fail() {
  if check; then
    echo "physics.sh --check did not notice $1" >&2
    exit 1
  fi
  grep -q "$2" "$scratch/log" || { echo "Not reported: $1" >&2; cat "$scratch/log" >&2; exit 1; }
}

line >"$scratch/lines/a"
awk -v faults=/dev/null -f "$here/physics.awk" "$scratch/lines/a" >"$THIMBLE_PHYSICS_PAGE"
check || { cat "$scratch/log" >&2; exit 1; }
line -1.21 2e-3 >"$scratch/lines/a" && must_fail "an error above its bound" "error 2e-3 is not within"
line nan nan >"$scratch/lines/a" && must_fail "an error that is not a number" "error nan is not"
line -1.2 4e-4 >"$scratch/lines/a" && must_fail "an old page" "differs from the measurements"
echo "PHYSICS|torn" >"$scratch/lines/a" && must_fail "a torn line" "a malformed line"
: >"$scratch/lines/a" && must_fail "a run that left no values" "no test has reported"
echo "physics.sh --check reports all invented errors."
