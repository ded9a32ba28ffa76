#!/usr/bin/env bash
# Shows that an energy stage or a heat guard that no file names costs nothing: none of its functions is called
# (callgrind names a function once, as caller or callee). A tick only pays three tests of one flag (guarded_ in device.h).
#   unnamed_gate_stage_costs_nothing.sh GATE_TICKS
set -euo pipefail
program=$1
command -v valgrind >/dev/null || {
  echo "NOTE: valgrind is not installed; nothing was counted (Debian: valgrind)."
  exit 77
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
stages='pass_guarded|WorkAccount::(flow|hold|sent)|PassivityObserver|bounded_force'
heat='HeatGuard::(advance|sent|limit)'

# instructions STAGE TICKS: instructions of the whole run; the called functions are in STAGE.out.
instructions() {
  valgrind --tool=callgrind --callgrind-out-file="$folder/$1.out" "$program" "$1" "$2" 2>&1 >/dev/null |
    sed -n 's/.*Collected : //p'
}

bad=0
for stage in none passivity bounding heat; do
  one=$(instructions "$stage" 1000)
  three=$(instructions "$stage" 3000)
  echo "$stage: $(((three - one) / 2000)) instructions per tick of the device"
  calls=$(grep -cE "^c?fn=.*($stages)" "$folder/$stage.out" || true)
  warm=$(grep -cE "^c?fn=.*$heat" "$folder/$stage.out" || true)
  if [ "$stage" != heat ] && [ "$warm" -ne 0 ]; then
    echo "  the heat guard ran although no file names it"
    bad=1
  fi
  if [ "$stage" = heat ] && [ "$warm" -eq 0 ]; then
    echo "  the heat guard did not run, so this test cannot fail"
    bad=1
  fi
  if [ "$stage" = none ] && [ "$calls" -ne 0 ]; then
    echo "  a stage ran that no file names"
    bad=1
  fi
  if [ "$stage" != none ] && [ "$calls" -eq 0 ]; then
    echo "  the stage did not run, so this test cannot fail"
    bad=1
  fi
done
exit $bad
