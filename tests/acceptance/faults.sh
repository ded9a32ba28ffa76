#!/usr/bin/env bash
# Runs the fault matrix and writes promises and measurements as a table: fault by arm, a
# column per phase. Results in simulated time are equal on every machine; for results on the
# wall clock the table states only whether the promise was kept.
#   tests/acceptance/faults.sh [BUILD_DIR [OUTPUT]]    default: build/release and tests/acceptance/FAULTS.md
#   tests/acceptance/faults.sh --check LINES           LINES: output of FaultMatrix (THIMBLE_FAULTS); fails if
#                                           tests/acceptance/FAULTS.md differs; writes nothing
set -euo pipefail
cd "$(dirname "$0")/../.."

simulated_rows() {  # simulated_rows LINES
  awk -F'|' '
    $3 == "process" || $4 == "link" || $4 == "identify" { next }
    {
      key = $2 "|" $3
      if (!(key in seen)) { seen[key] = 1; order[++n] = key }
      if ($4 != "opening") { promise[key] = $5; limit[key] = $7 }
      value = $6
      sub(/goes on/, "-", value)
      cell[key "|" $4] = value
    }
    END {
      split("opening free contact sliding deforming recording", phases, " ")
      for (i = 1; i <= n; ++i) {
        split(order[i], part, "|")
        line = "| " part[1] " | " part[2] " | " promise[order[i]] " | " limit[order[i]] " |"
        for (p = 1; p <= 6; ++p) line = line " " cell[order[i] "|" phases[p]] " |"
        print line
      }
    }' "$1" | sort -t'|' -s -k2,2
}

if [ "${1:-}" = --check ]; then
  [ $# = 2 ] || { echo "Usage: tests/acceptance/faults.sh --check LINES" >&2; exit 2; }
  diff <(sed -n '/^## In simulated time/,/^## While/p' tests/acceptance/FAULTS.md | sed -n '/^| fault/d; /^|-/d; /^|/p' | sort) \
    <(simulated_rows "$2" | sort) >&2 || {
    echo "FAILED: tests/acceptance/FAULTS.md (<) is not what the matrix measured (>): write it anew by tests/acceptance/faults.sh, and look at what changed" >&2
    exit 1
  }
  exit 0
fi
build=${1:-build/release}
output=${2:-tests/acceptance/FAULTS.md}
lines=$(mktemp)
trap 'rm -f "$lines"' EXIT
THIMBLE_FAULTS=$lines "$build/tests/sim/test_faults" --gtest_filter="*FaultMatrix*" >/dev/null
THIMBLE_FAULTS=$lines "$build/tests/sim/test_identify" --gtest_filter='IdentifyBounds.*' >/dev/null
[ ! -e "$build/tests/unit/driver/test_links" ] ||
  THIMBLE_FAULTS=$lines "$build/tests/unit/driver/test_links" --gtest_filter='*Link*Names*' >/dev/null
[ ! -e "$build/app/thimble" ] ||
  THIMBLE_FAULTS=$lines bash tests/program/faults_test.sh "$(realpath "$build/app/thimble")" "$PWD" \
    "$(realpath "$build")/tests/program/faults_table" >/dev/null || [ $? = 77 ]
{
  cat <<'TEXT'
# Faults: what is promised, and what was measured

Written by `tests/acceptance/faults.sh`; do not edit. The promises are data in `tests/sim/fault_promises.h`, the cells are
`tests/sim/fault_matrix_test.cpp` (simulated time, the whole way from hand to motors), `tests/sim/identify/identify_bounds_test.cpp`,
`tests/unit/driver/vendors/*_link_test.cpp` (arms behind vendors' libraries and services) and `tests/program/faults_test.sh` (real
processes).

A number is the time in ms until no current flowed in the motors of the simulated arm, for good; behind it the cause that
the driver named. `-` is a touch that went on, every force sent within the arm's limit. In the column `limit`: no later than so
many ms. "the arm switches off": the board's own watchdog (100 ms, mbed boards 500 ms), for the driver cannot know. Whether a Falcon has a
watchdog is not known: the simulated one of these rows has none, and where only the arm could switch its motors off nothing
is promised ("goes on" as `-`: the motors still pulled when the watching ended). Free motion has no current
to begin with. "within the limit" is what can be promised of bytes that look like a touch: no wire of these arms has a
checksum. Forces on the way out that a cable has changed are the board's business: it takes no current beyond its range.

## In simulated time

| fault | arm | promise | limit | opening | free | contact | sliding | deforming | recording |
|---|---|---|---|---|---|---|---|---|---|
TEXT
  simulated_rows "$lines"
  cat <<'TEXT'

## While an arm is identified, in simulated time

Arms with hidden constants (2 for each row, 40 in the long form). Every command of `thimble identify` counts, from opening to end,
as it was asked for and as it was sent.

| fault | promise | result |
|---|---|---|
TEXT
  awk -F'|' '$4 == "identify" { print "| " $2 " | " $5 " | " $6 " |" }' "$lines"
  cat <<'TEXT'

## Behind a vendor's library or service, on the wall clock

Over libraries and a service of our own that stand in for the vendors'. "more with a force": messages with a force that still go out
once the fault is there, before zero does for good; the cause latches. What a library or service that hangs does with the
last force is its own business: Force Dimension's arm is asked to let it go after 20 ms.

| fault | library or service | promise | result |
|---|---|---|---|
TEXT
  awk -F'|' '$4 == "link" { print "| " $2 " | " $3 " | " $5 " | " $6 " |" }' "$lines"
  cat <<'TEXT'

## With real processes, on the wall clock

| fault | while | promise | result |
|---|---|---|---|
TEXT
  awk -F'|' '$3 == "process" { print "| " $2 " | " $4 " | " $5 " | " $6 " |" }' "$lines"
} >"$output"
echo "$output: $(grep -c '^| ' "$output") rows"
