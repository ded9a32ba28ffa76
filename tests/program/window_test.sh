#!/usr/bin/env bash
# The appearance of the window on a virtual screen (Debian: xvfb, xdotool), compared with stored smaller pictures: a paused
# recording, light, dark and in the smallest window, and the target of a hand led by the keyboard.
# After an intended change THIMBLE_WRITE_SHOTS=1 stores the new pictures.
source "$(dirname "$0")/expect.sh" "$@"
unset DISPLAY WAYLAND_DISPLAY
here=$source_dir/tests/program
for tool in Xvfb xdotool; do
  command -v $tool >/dev/null || {
    leave_out "the window, for want of $tool (as root: apt-get install xvfb xdotool)"
    finish
  }
done
source "$here/screen.sh"

expect 0 '' "$thimble" run "$source_dir/app/scenes/tin_can.yaml" --record touch.h5 --no-view

# same_as_kept NAME PICTURE FACTOR...: PICTURE, or its given part (left, top, width, height), reduced by FACTOR, equals the stored one
same_as_kept() {
  local kept=$source_dir/tests/data/shots/window_$1.png
  /usr/bin/python3 "$here/shrink_picture.py" "$2" "$1.small.png" "${@:3}"
  [ -z "${THIMBLE_WRITE_SHOTS:-}" ] || cp "$1.small.png" "$kept"
  expect 0 '^the same' /usr/bin/python3 "$here/picture_near.py" "$kept" "$1.small.png"
}
# looks NAME WIDTH HEIGHT OPTION...: the window of this size equals the stored picture.
looks() {
  local name=$1 width=$2 height=$3
  shift 3
  "$thimble" view touch.h5 --at 4.2 --for 4 --picture "$name.png" "$@" 2>"$name.txt" &
  local viewer=$!
  wait_for 60 xdotool search --onlyvisible --name "Thimble: tin_can"
  xdotool search --onlyvisible --name "Thimble: tin_can" windowsize "$width" "$height"
  wait $viewer
  expect 0 '^0$' echo $?
  same_as_kept "$name" "$name.png" 4
}
looks light 960 640
looks dark 960 640 --theme dark
looks least 700 420

# The hand is led into the side of a rough cube, until the target has its largest distance from the tip.
cat >cube.yaml <<END
name: cube
duration: 1
arm: $source_dir/app/arms/vintage_phantom.yaml
objects:
  - name: cube
    box: {sides: [0.05, 0.05, 0.05]}
    position: [0, -0.03, 0]
    stiffness: 600
    damping: 1
    effects:
      - {friction: bristle, coefficient: 1.5}
hand:
  grip: {stiffness: 40, damping: 2}
  path: [{t: 0, at: [0, 0.02, 0]}, {t: 1, at: [0, 0.02, 0]}]
END
me=window$$
"$thimble" run cube.yaml --hand keyboard --no-view --name "$me" >run.txt 2>&1 &
run=$!
expect 0 '' bash -c "$(declare -f wait_for); wait_for 60 '$thimble' view '$me' --text --for 0.1"
"$thimble" view "$me" --hand keyboard --for 8 --picture led.png 2>led.txt &
viewer=$!
wait_for 60 xdotool search --onlyvisible --name "Thimble: cube"
window=$(xdotool search --onlyvisible --name "Thimble: cube" | head -1)
xdotool windowsize "$window" 960 640
xdotool windowfocus "$window" 2>/dev/null
xdotool keydown Left
wait $viewer
expect 0 '^0$' echo $?
xdotool keyup Left
"$thimble" view "$me" --stop
wait $run
# Only the target and the line from it to the tip: in a larger part they would hardly count.
same_as_kept led led.png 2 50 330 280 30
finish
