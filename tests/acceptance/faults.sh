#!/usr/bin/env bash
# Runs the fault matrix and writes promises and measurements as a table: a row per fault and arm, a
# column per phase. Results in simulated time are equal on every machine. For results in real time
# the table states only whether the promise was kept.
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
      sub(/continues/, "-", value)
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
    echo "FAILED: tests/acceptance/FAULTS.md (<) differs from the measurements (>). Run tests/acceptance/faults.sh and review the changes" >&2
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
# Faults: promises and measurements

Written by `tests/acceptance/faults.sh`; do not edit. The promises are in `tests/sim/fault_promises.h`. The cells are measured by
`tests/sim/fault_matrix_test.cpp` (simulated time, from the hand to the motors), `tests/sim/identify/identify_bounds_test.cpp`,
`tests/unit/driver/vendors/*_link_test.cpp` (arms behind vendors' libraries and services) and `tests/program/faults_test.sh` (real
processes).

A number is the time in ms until the currents in the motors of the simulated arm have ended permanently; the fault that the
driver reported follows it. `-`: the contact continued, and every sent force was within the arm's limit. The column `limit` is the
maximum time in ms. "the arm switches off": the driver cannot detect the fault, and the board's own watchdog acts (100 ms, mbed
boards 500 ms). It is not known whether a Falcon has a watchdog. The simulated Falcon of these rows has none. If only the arm
could switch its motors off, nothing is promised, and `-` means that the motors still pulled at the end of the observation. In
free motion there is no current at the start. "within the limit" is all that can be promised for corrupt bytes that look
valid, because of these wires only that of vintage_described has a checksum. The board must handle forces that the cable has corrupted: it accepts no
current beyond its range.

## In simulated time

| fault | arm | promise | limit | opening | free | contact | sliding | deforming | recording |
|---|---|---|---|---|---|---|---|---|---|
TEXT
  simulated_rows "$lines"
  cat <<'TEXT'

## While an arm is identified, in simulated time

Arms with hidden constants (2 for each row, 40 in the long form). Every command of `thimble identify` counts, from opening to end,
both as requested and as sent.

| fault | promise | result |
|---|---|---|
TEXT
  awk -F'|' '$4 == "identify" { print "| " $2 " | " $5 " | " $6 " |" }' "$lines"
  cat <<'TEXT'

## Behind a vendor's library or service, on the wall clock

Mock libraries and a mock service replace those of the vendors. "more with a force": messages with a force that are still sent
after the fault, before only zero is sent; the fault latches. If a library or service hangs, it decides about the last force:
Force Dimension's arm is set to end it after 20 ms.

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
