#!/usr/bin/env bash
# What the window looks like, on a screen in memory (Debian: xvfb, xdotool): a recording that stands still, light, dark and as
# small as a window may be, against kept pictures of a quarter of the size. THIMBLE_WRITE_SHOTS=1 keeps what there is now, after a
# change that is meant.
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

expect 0 'Recording' "$thimble" run "$source_dir/app/scenes/tin_can.yaml" --record touch.h5 --no-view

# looks NAME WIDTH HEIGHT OPTION...: the window of that size shows what is kept.
looks() {
  local name=$1 width=$2 height=$3
  shift 3
  "$thimble" view touch.h5 --at 4.2 --for 4 --picture "$name.png" "$@" 2>"$name.txt" &
  local viewer=$!
  wait_for 60 xdotool search --onlyvisible --name "Thimble: tin_can"
  xdotool search --onlyvisible --name "Thimble: tin_can" windowsize "$width" "$height"
  wait $viewer
  expect 0 '^0$' echo $?
  /usr/bin/python3 "$here/shrink_picture.py" "$name.png" "$name.small.png" 4
  local kept=$source_dir/tests/data/shots/window_$name.png
  [ -z "${THIMBLE_WRITE_SHOTS:-}" ] || cp "$name.small.png" "$kept"
  expect 0 '^the same' /usr/bin/python3 "$here/picture_near.py" "$kept" "$name.small.png"
}
looks light 960 640
looks dark 960 640 --theme dark
looks least 700 420
finish
