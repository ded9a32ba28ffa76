#!/usr/bin/env bash
# Shows that bodies that move or bend, force fields, and splitting of clay cost nothing in a scene without them: a tick
# calls none of their functions, and calls only the object's own law and the observers of every run.
#   absent_bodies_and_fields_cost_nothing.sh SCENE_TICKS SOURCE_DIR
set -euo pipefail
program=$1 source=$2
command -v valgrind >/dev/null || {
  echo "NOTE: valgrind is not installed; nothing was counted (Debian: valgrind)."
  exit 77
}
. "$(dirname "$0")/tick_calls.sh"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
bad=0

# Every class in these folders, so that new ones are included.
classes() {
  grep -rhoE '^(class|struct) [A-Z][A-Za-z]+' "$@" | awk '{ print $2 }' | sort -u | paste -sd'|'
}
bodies="(render::($(classes "$source/render/src/body"))|session::(DentRecord|PoseRecord))\\b"
fields="render::($(classes "$source/render/src/field" "$source/render/include/thimble/render/field"))\\b"

# used PATTERN TAG: the functions of these classes that ticks call.
used() {
  cut -f2 "$folder/$2.calls" | grep -E "$1" | sort -u || true
}

tick_calls "$program" "$source/tests/data/scenes/plain_ball.yaml" "$folder" plain
read -r instructions contact <"$folder/plain.ticks"
echo "a plain ball: $instructions instructions per tick, in contact in $contact of them"
for what in bodies fields; do
  found=$(used "${!what}" plain)
  if [ -n "$found" ]; then
    echo "  ticks of a scene without $what call:"
    echo "$found" | sed 's/^/    /'
    bad=1
  fi
done

# A call of other code would come from one of these two.
expect() {
  local caller=$1 expected=$2 found
  found=$(callees "$folder/plain.calls" "$caller" | sed -E 's/.*::([A-Za-z]+::)/\1/' | paste -sd' ')
  if [ "$found" != "$expected" ]; then
    echo "  $caller calls in a tick: $found"
    echo "  expected: $expected"
    bad=1
  fi
}
expect 'ForceLaw<thimble::render::SceneTouch>(thimble::render::SceneTouch&)::{lambda' 'ObjectTouchAdapter::update'
expect 'TickSink<thimble::session::RunLoop>(thimble::session::RunLoop&)::{lambda' \
  'BlackBox::take LatestTick::take RecordingSwitch::take RunStatistics::take Trace::take'

# The searched functions are called in a scene that uses them.
tick_calls "$program" "$source/app/scenes/clay.yaml" "$folder" clay
tick_calls "$program" "$source/app/scenes/honey.yaml" "$folder" honey
# Clay that splits no triangles calls none of the splitting code.
splits='PrintRefinement|split_edge|EdgeSplit'
found=$(used "$splits" clay)
if [ -n "$found" ]; then
  echo "  ticks of clay without an edge call:"
  echo "$found" | sed 's/^/    /'
  bad=1
fi
tick_calls "$program" "$source/app/scenes/clay_tablet.yaml" "$folder" clay_tablet
for pair in bodies:clay fields:honey splits:clay_tablet; do
  what=${pair%:*}
  count=$(used "${!what}" "${pair#*:}" | wc -l)
  echo "${pair#*:}: ticks call $count functions of $what"
  if [ "$count" -eq 0 ]; then
    echo "  none, so this test cannot fail"
    bad=1
  fi
done
exit $bad
