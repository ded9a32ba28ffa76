#!/usr/bin/env bash
# Shows that parts of the simulated plant cost nothing if an arm file does not name them. With drive train, weight, jitter, loss
# and missed edges absent or zero, a tick executes the same instructions and none of their functions. Prints the cost of each term.
#   unnamed_drive_train_costs_nothing.sh PLANT_TICKS SOURCE_DIR
set -euo pipefail
program=$1 source=$2
command -v valgrind >/dev/null || {
  echo "NOTE: valgrind is not installed; nothing was counted (Debian: valgrind)."
  exit 77
}
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
arm=$source/app/arms/vintage_phantom.yaml
ticks=200
bad=0

# variant NAME [SED...]: the arm's file with other lines.
variant() {
  local name=$1
  shift
  cp "$arm" "$folder/$name.yaml"
  for edit in "$@"; do sed -i "$edit" "$folder/$name.yaml"; done
}
train() { echo "s/^simulation:/&\n  drive_train: {$1}/"; }
cables='stiffness: [500, 500, 500], inertia: [0.0001, 0.0001, 0.0001], damping: [0.01, 0.01, 0.01]'
variant none
variant zeros "$(train 'current_lag: 0, cogging: [0, 0, 0], ripple: [0, 0, 0], periods_per_turn: 0, cogging_phase: [0, 0, 0], ripple_phase: [0, 0, 0], inertia: [0, 0, 0], stiffness: [0, 0, 0], damping: [0, 0, 0], play: [0, 0, 0], viscous: [0, 0, 0], coulomb: [0, 0, 0]')" \
  's/^  tip:/&\n    weight: 0/' 's/^  wire:/&\n    jitter: 0\n    loss: 0/' 's/^  firmware:/&\n    missed_edges: 0/'
variant weight 's/^  tip:/&\n    weight: 0.02/'
variant current_lag "$(train 'current_lag: 0.0005')"
variant cogging "$(train 'cogging: [0.0005, 0.0005, 0.0005], periods_per_turn: 7')"
variant ripple "$(train 'ripple: [0.02, 0.02, 0.02], periods_per_turn: 7')"
variant cables "$(train "$cables")"
variant cables_and_play "$(train "$cables, play: [0.001, 0.001, 0.001]")"
variant jitter 's/^  wire:/&\n    jitter: 0.0001/'
variant loss 's/^  wire:/&\n    loss: 0.01/'
variant missed_edges 's/^  firmware:/&\n    missed_edges: 0.001/'

# Symbols are bound at load, so that no tick includes the linker's work.
export LD_BIND_NOW=1
# count NAME: instructions of a tick; the called functions are in NAME.out.
count() {
  valgrind --tool=callgrind --compress-strings=no --toggle-collect='*counted_ticks*' --callgrind-out-file="$folder/$1.out" \
    "$program" "$folder/$1.yaml" $ticks 2>&1 >"$folder/$1.moved" | sed -n 's/.*Collected : //p'
}
# ran NAME FUNCTIONS: whether any of the functions was called.
ran() { grep -qE "^c?fn=.*($2)" "$folder/$1.out"; }
train_functions='DriveTrain(Plant<.*>)?::(ask|step|sub_step|turn_rotors|cable_pull|set_currents|advance)'

names='none zeros weight current_lag cogging ripple cables cables_and_play jitter loss missed_edges'
for name in $names; do
  count "$name" >"$folder/$name.count"
  whole=$(cat "$folder/$name.count")
  if [ -z "$whole" ] || [ "$whole" -lt $((1000 * ticks)) ]; then
    echo "$name: ${whole:-no} instructions: too few for $ticks ticks"
    exit 1
  fi
  plain=$(cat "$folder/none.count")
  printf '%-16s %8d instructions per tick, %+d\n' "$name" $((whole / ticks)) $(((whole - plain) / ticks))
done
if [ "$(($(cat "$folder/zeros.count") / ticks))" != "$(($(cat "$folder/none.count") / ticks))" ]; then
  echo "Terms with a value of zero cost instructions."
  bad=1
fi
for name in none zeros; do
  if ran "$name" "$train_functions"; then
    echo "$name: functions of the drive train run without a drive train"
    bad=1
  fi
done
for name in weight current_lag cogging ripple cables cables_and_play; do
  ran "$name" "$train_functions" || { echo "$name: no function of the drive train ran, so this test cannot fail"; bad=1; }
done
for name in jitter loss missed_edges; do
  # Random draws are inlined into their caller, so only their cost shows them.
  [ "$(cat "$folder/$name.count")" -gt "$(cat "$folder/none.count")" ] || { echo "$name: no random number was drawn, so this test cannot fail"; bad=1; }
done
exit $bad
