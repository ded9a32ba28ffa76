#!/usr/bin/env bash
# Counts the instructions of a tick in plain contact, a mesh without any effect, and of its parts. Fails if they
# exceed the bounds below. They are equal in every run of the same program.
#   plain_contact_costs.sh SCENE_TICKS SOURCE_DIR COMPILER MESHES
# The bounds are the counts of GCC 12 for x86-64 with FMA and AVX2 plus 8 %: searches depend on the processor.
# For another compiler the figures are only printed. The elephant needs its scanned mesh.
set -euo pipefail
program=$1 source=$2 compiler=$3 meshes=$4
command -v valgrind >/dev/null || {
  echo "NOTE: valgrind is not installed; nothing was counted (Debian: valgrind)."
  exit 77
}
. "$(dirname "$0")/tick_calls.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
bad=0

# bound NAME COUNT MAX
bound() {
  local said=""
  if [ "$2" -gt "$3" ]; then
    said=" TOO MANY"
    if [[ "$compiler" == "GNU 12."* ]] && grep -qw fma /proc/cpuinfo; then bad=1; fi
  fi
  printf '  %-34s %6d, at most %6d%s\n' "$1" "$2" "$3" "$said"
}

# count SCENE WHOLE LAW: WHOLE and LAW are the bounds of the tick and of its force law. The parts add up to the whole.
count() {
  local tag contact whole law observers arm_read arm_write link_read read write
  tag=$(basename "$1" .yaml)
  tick_calls "$program" "$1" "$folder" "$tag"
  read -r whole contact <"$folder/$tag.ticks"
  part() { instructions_of "$folder/$tag.calls" "$1"; }
  law=$(part 'SceneTouch&)::{lambda') observers=$(part 'RunLoop&)::{lambda')
  arm_read=$(part 'SimTransport::read_latest(') arm_write=$(part 'SimTransport::write(')
  link_read=$(part 'WireLink::read(') read=$(part 'Device::read(') write=$(part 'Device::write(')
  echo "$tag: instructions per tick"
  bound "whole tick" "$whole" "$2"
  bound "simulated arm, reading" "$arm_read" 1969
  bound "simulated arm, writing" "$arm_write" 134
  bound "decode, kinematics, Jacobian" $((link_read - arm_read)) 548
  bound "checks of a report, velocity" $((read - link_read)) 292
  bound "force law" "$law" "$3"
  bound "gate, currents, guards, books" $((write - arm_write)) 1190
  bound "observers of the run" "$observers" 702
  bound "loop" $((whole - read - law - write - observers)) 354
  if awk -v share="$contact" 'BEGIN { exit share > 0.95 }'; then
    echo "  in contact in only $contact of the ticks: this is not a tick in contact"
    bad=1
  fi
}

count "$source/tests/data/scenes/plain_ball.yaml" 5464 477
if [ -f "$meshes/elephant.off" ]; then
  count "$source/tests/data/scenes/stroke.yaml" 5917 880
else
  echo "NOTE: no elephant.off in $meshes; its ticks were not counted."
fi
exit $bad
