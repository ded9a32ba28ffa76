#!/usr/bin/env bash
# A program for another arm with Thimble's window: `thimble exec --view` shows the scene and the tip, and the mouse
# leads the hand of the program's arm. On a virtual screen (Debian: xvfb, xdotool).
#   view_test.sh THIMBLE SOURCE_DIR WORK_DIR CLIENTS_DIR
for tool in Xvfb xdotool; do
  command -v $tool >/dev/null || {
    echo "SKIPPED: the window of \`thimble exec\` was NOT tested: $tool is missing (as root: apt-get install xvfb xdotool)" >&2
    exit 77
  }
done
source "$(dirname "$0")/../program/expect.sh" "$1" "$2" "$3"
clients=$4
unset WAYLAND_DISPLAY
source "$(dirname "$0")/../program/screen.sh"

"$thimble" exec --scene "$source_dir/tests/data/scenes/two_boxes.yaml" --hand mouse --view "$clients/led" 60 >led.txt 2>&1 &
run=$!
wait_for 30 grep -q ready led.txt
wait_for 30 xdotool search --onlyvisible --name Thimble
window=$(xdotool search --onlyvisible --name Thimble | head -1)
expect 0 '^WIDTH=[0-9]{3}' xdotool getwindowgeometry --shell "$window"
eval "$(xdotool getwindowgeometry --shell "$window")"
# From the middle of the window to the right and up, in small steps; repeated if the first frame was not drawn yet.
drag() {
  xdotool mousemove $((X + WIDTH / 3)) $((Y + HEIGHT / 2)) mousedown 1
  for _ in $(seq 20); do
    xdotool mousemove_relative -- 6 -4
    sleep 0.05
  done
  wait_for 2 grep -q led led.txt
  local led=$?
  xdotool mouseup 1
  return $led
}
wait_for 40 drag
cp Xvfb_screen0 screen.xwd
expect_own 0 '^led [1-9][0-9].* mm: [1-9].* to the right, [1-9].* up' cat led.txt
# The screen with the program's own window: an empty one compresses to 10 kB.
expect 0 '^[0-9]{6,}$' bash -c 'gzip -c screen.xwd | wc -c'
expect 0 '' "$thimble" view two_boxes --for 2 --picture window.png
expect 0 '^[0-9]{6,}$' stat -c %s window.png # an empty window takes 11 kB
wait $run
status=$?
expect 0 '^0$' echo $status
grep '^led' led.txt
finish
