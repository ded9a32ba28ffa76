#!/usr/bin/env bash
# The start window on a virtual screen (Debian: xvfb, xdotool): its pictures, a mesh that becomes a scene, runs that it starts,
# ends and restarts, and a run that fails.
# After an intended change THIMBLE_WRITE_SHOTS=1 stores the new pictures.
source "$(dirname "$0")/expect.sh" "$@"
unset DISPLAY WAYLAND_DISPLAY
here=$source_dir/tests/program
# Without a screen, `thimble` prints its help, and there is no start window.
expect_words 0 'thimble OPTIONS SUBCOMMAND' "$thimble"
expect_words 1 'window screen' "$thimble" view --start
expect_words 2 '--start' "$thimble" view --start --pause
expect_words 2 '--start' "$thimble" view --start a.yaml b.yaml
for tool in Xvfb xdotool; do
  command -v $tool >/dev/null || {
    leave_out "the window, for want of $tool (as root: apt-get install xvfb xdotool)"
    finish
  }
done
source "$here/screen.sh"
export XDG_STATE_HOME=$work/state XDG_DATA_HOME=$work/data XDG_CACHE_HOME=$work/cache
xdotool mousemove 1299 819

# same_as_kept NAME PICTURE FACTOR: PICTURE reduced by FACTOR equals the stored one
same_as_kept() {
  local kept=$source_dir/tests/data/shots/start_$1.png
  /usr/bin/python3 "$here/shrink_picture.py" "$2" "$1.small.png" "$3"
  [ -z "${THIMBLE_WRITE_SHOTS:-}" ] || cp "$1.small.png" "$kept"
  expect 0 '^the same' /usr/bin/python3 "$here/picture_near.py" "$kept" "$1.small.png"
}
# looks NAME WIDTH HEIGHT OPTION...: the start window of this size equals the stored picture.
looks() {
  local name=$1 width=$2 height=$3
  shift 3
  "$thimble" view --start --for 5 --picture "$name.png" "$@" 2>"$name.txt" &
  local viewer=$!
  wait_for 60 xdotool search --onlyvisible --name '^Thimble$'
  xdotool search --onlyvisible --name '^Thimble$' windowsize "$width" "$height"
  wait $viewer
  expect 0 '^0$' echo $?
  same_as_kept "$name" "$name.png" 4
}
looks light 960 640
looks dark 960 640 --theme dark
looks least 700 420

# open_window FILE...: opens the start window, and keeps its id and its process.
open_window() {
  "$thimble" view --start --for 120 "$@" >said.txt 2>&1 &
  viewer=$!
  wait_for 60 xdotool search --onlyvisible --name '^Thimble$'
  window=$(xdotool search --onlyvisible --name '^Thimble$' | head -1)
  xdotool windowfocus "$window" 2>/dev/null
}
press() { xdotool key "$@"; }
# closes: the window closes by the key Q, and its process ends well.
closes() {
  press q
  wait $viewer
  expect 0 '^0$' echo $?
}
runs() { "$thimble" view --list; }
run_listed() { runs | grep -q "^$1: "; }
no_run_listed() { ! run_listed "$1"; }
# A word about the window, for the output of a failure.
shown() { xdotool search --onlyvisible --name "^Thimble: $1\$"; }

process_of() { runs | sed -n "s/^$1: .*, process \([0-9]*\)$/\1/p"; }
words_of() { tr '\0' ' ' <"/proc/$1/cmdline"; }
knob_is() { runs | grep -q " $1 = $2 "; }

# A mesh becomes a scene, and is run; closing the window ends the run, and says so.
cat >"my part.off" <<'END'
OFF
4 4 0
0 0 0
30 0 0
0 30 0
0 0 30
3 0 2 1
3 0 1 3
3 0 3 2
3 1 2 3
END
open_window
expect_own 0 '' timeout 30 /usr/bin/python3 "$here/drop_file.py" "$window" "my part.off"
wait_for 30 test -s "$XDG_STATE_HOME/thimble/start/my_part.yaml"
sleep 0.5
press Return
expect_own 0 '' wait_for 60 shown 'my part'
expect_own 0 '' wait_for 10 run_listed my_part
closes
expect_own 0 '' wait_for 10 no_run_listed my_part
expect_own 0 . grep -E 'ends the run my_part' said.txt
expect_own 0 '/my part.off$' cat "$XDG_STATE_HOME/thimble/recent_scenes"

# A run that has ended is still shown, and B runs it again; a second one has the same name.
cat >short.yaml <<END
name: short
duration: 2
arm: $source_dir/app/arms/vintage_phantom.yaml
objects: [{name: ball, sphere: {radius: 0.02}, position: [0, 0, 0], stiffness: 300, damping: 1}]
hand: {path: [{t: 0, at: [0, 0, 0.03]}, {t: 2, at: [0, 0, 0.04]}]}
END
open_window short.yaml
press Return
expect_own 0 '' wait_for 60 shown short
expect_own 0 '' wait_for 10 run_listed short
expect 0 '' "$thimble" view short --stop
expect_own 0 '' wait_for 30 no_run_listed short
expect_own 0 . shown short
sleep 1
press b
expect_own 0 '' wait_for 30 run_listed short
closes
expect_own 0 '' wait_for 10 no_run_listed short

# The dialog of the desktop, and a typed path.
click() {
  xdotool mousemove "$1" "$2"
  sleep 0.3
  xdotool mousedown 1
  sleep 0.2
  xdotool mouseup 1
  sleep 0.3
}
mkdir desktop
cat >desktop/zenity <<END
#!/bin/sh
echo "\$@" >"$work/asked.txt"
echo "$work/short.yaml"
END
chmod +x desktop/zenity
PATH=$work/desktop:$PATH open_window
sleep 2
click 845 87 # Browse...
expect_own 0 '' wait_for 30 grep -q file-selection asked.txt
sleep 1
press Return
expect_own 0 '' wait_for 60 run_listed short
closes
expect_own 0 '' wait_for 10 no_run_listed short
cp short.yaml typed.yaml
open_window
# A slow machine may lose a click or a key.
types_path() {
  click 300 87 # the field
  press ctrl+a
  xdotool type --delay 100 "$work/typed.yaml"
  press Return
  sleep 3
  press Return
  wait_for 20 run_listed typed
}
expect_own 0 '' wait_for 90 types_path
closes
expect_own 0 '' wait_for 10 no_run_listed typed
expect_own 0 '/typed.yaml$' cat "$XDG_STATE_HOME/thimble/recent_scenes"

# A scene with a mistake leads back to the scenes, with its error.
echo 'objects: [' >wrong.yaml
open_window wrong.yaml
press Return
expect_own 0 '' wait_for 30 grep -q 'wrong.yaml' said.txt
expect_own 0 . xdotool search --onlyvisible --name '^Thimble$'
kill $viewer
wait $viewer 2>/dev/null

# A window that is killed takes its run with it.
open_window short.yaml
press Return
expect_own 0 '' wait_for 60 run_listed short
kill -9 $viewer
wait $viewer 2>/dev/null
expect_own 0 '' wait_for 10 no_run_listed short

# The window of `thimble run --view` starts an ended run again, and ends it when it closes.
"$thimble" run short.yaml --view --duration 3 --seed 7 --name again >run.txt 2>&1 &
run=$!
expect_own 0 '' wait_for 60 shown short
window=$(shown short | head -1)
xdotool windowfocus "$window" 2>/dev/null
first=$(process_of again)
expect 0 '' "$thimble" view again --turn 'ball: stiffness=250'
wait $run
expect_own 0 '' wait_for 10 no_run_listed again
expect_own 0 . shown short
sleep 1
press b
expect_own 0 '' wait_for 30 run_listed again
expect_own 1 '' [ "$(process_of again)" = "$first" ]
expect_own 0 '' wait_for 10 knob_is 'ball: stiffness' 250
expect_own 0 '--clock=paced --reload --duration=3 --seed=7' words_of "$(process_of again)"
# After its end, once more.
expect 0 '' "$thimble" view again --stop
expect_own 0 '' wait_for 30 no_run_listed again
sleep 1
press b
expect_own 0 '' wait_for 30 run_listed again
press q
expect_own 0 '' wait_for 10 no_run_listed again
expect_own 0 . grep -E 'ends the run again' run.txt

# A window without a run says so, and shows the run when it starts.
"$thimble" view later --for 3 --picture wait.png 2>wait.txt
expect 0 '^0$' echo $?
expect_own 0 '' test -s wait.png
"$thimble" view later --for 120 >said.txt 2>&1 &
viewer=$!
expect_own 0 '' wait_for 60 xdotool search --onlyvisible --name '^Thimble$'
"$thimble" run short.yaml --no-view --clock paced --name later >run.txt 2>&1 &
run=$!
expect_own 0 '' wait_for 30 shown short
kill $viewer
wait $viewer 2>/dev/null
wait $run
# Its button opens the scenes.
"$thimble" view later --for 8 --picture scenes.png >said.txt 2>&1 &
viewer=$!
expect_own 0 '' wait_for 60 xdotool search --onlyvisible --name '^Thimble$'
window=$(xdotool search --onlyvisible --name '^Thimble$' | head -1)
xdotool windowfocus "$window" 2>/dev/null
press Return
wait $viewer
expect_own 1 '' cmp -s wait.png scenes.png

# A broken list of recent files is ignored, with a warning.
echo broken >"$XDG_STATE_HOME/thimble/recent_scenes"
expect 0 'recent_scenes' "$thimble" view --start --for 1

# `thimble` alone opens it on a desktop; without a run so does `thimble view`.
for words in '' view; do
  # shellcheck disable=SC2086
  "$thimble" $words >alone.txt 2>&1 &
  viewer=$!
  expect_own 0 '' wait_for 60 xdotool search --onlyvisible --name '^Thimble$'
  kill $viewer
  wait $viewer 2>/dev/null
done
finish
