#!/usr/bin/env bash
# Several recordings and own signals on one time line of the window, on a virtual screen (Debian: xvfb, xdotool): compared with
# stored smaller pictures. Wrong recordings, signals and options end with a message that names file, line and remedy.
# After an intended change THIMBLE_WRITE_SHOTS=1 stores the new pictures.
source "$(dirname "$0")/expect.sh" "$@"
unset DISPLAY WAYLAND_DISPLAY
here=$source_dir/tests/program

# A ball that is touched from two sides, by hands of different length, and another object.
scene() {
  cat >"$1.yaml" <<END_OF_SCENE
name: $1
duration: $2
arm: $source_dir/app/arms/vintage_phantom.yaml
objects:
  - name: $3
    position: [0, 0, -0.03]
    $4
    stiffness: $5
    damping: 2
hand:
  path:
    - {t: 0, at: [0, $6, 0.04]}
    - {t: 1, on: $3, near: [0, $6, 0.006], press: 0.006}
    - {t: $2, on: $3, near: [0.02, $6, 0.006], press: 0.008}
END_OF_SCENE
  expect 0 '' "$thimble" run "$1.yaml" --record "$1.h5" --no-view
}
scene stiff 3 ball 'sphere: {radius: 0.04}' 600 -0.02
scene soft 2 ball 'sphere: {radius: 0.04}' 300 0.02
scene cube 2 cube 'box: {sides: [0.05, 0.05, 0.05]}' 600 -0.01
awk 'BEGIN { print "time [ms], muscle [mV]"; for (i = 0; i < 3500; ++i) printf "%d, %.4f\n", i, 0.8 * sin(i / 200) * exp(-i / 1500) }' >muscle.csv

# Bad input needs no screen.
expect_error 2 'missing.csv' "$thimble" view stiff.h5 --signals missing.csv
printf 'time,a\n0,1\n0.5,nan\n' >bad.csv
expect_error 2 'bad.csv:3 "a" "nan"' "$thimble" view stiff.h5 --signals bad.csv
printf 'time,a\n0,1\n0.5,1\n0.4,1\n' >bad.csv
expect_error 2 'bad.csv:4 "0.4"' "$thimble" view stiff.h5 --signals bad.csv
printf 'time,a\n0,1,2\n' >bad.csv
expect_error 2 'bad.csv:2 3 2' "$thimble" view stiff.h5 --signals bad.csv
printf 'time\n0\n' >bad.csv
expect_error 2 'bad.csv:1 name unit' "$thimble" view stiff.h5 --signals bad.csv
expect_error 2 'stiff.h5:1 CSV' "$thimble" view stiff.h5 --signals stiff.h5
printf 'time,a\n1700000000,1\n1700000001,2\n' >bad.csv
expect_error 2 'bad.csv' "$thimble" view stiff.h5 --signals bad.csv
mkdir folder.csv
expect_error 2 'folder.csv' "$thimble" view stiff.h5 --signals folder.csv
truncate -s 3G bad.csv
expect_error 2 'bad.csv 2000 MB' "$thimble" view stiff.h5 --signals bad.csv
rm bad.csv
expect_error 2 '--scene-of cube.h5 stiff.h5' "$thimble" view stiff.h5 --scene-of cube.h5
expect_error 2 '7 6' "$thimble" view stiff.h5 soft.h5 cube.h5 stiff.h5 soft.h5 cube.h5 stiff.h5
expect_error 2 '--signals muscle.csv' "$thimble" view stiff.h5 muscle.csv
expect_error 2 '--signals FILE.h5' "$thimble" view --signals muscle.csv --start
expect_words 0 '--signals FILE' "$thimble" view --help
expect_words 0 '--scene-of FILE' "$thimble" view --help

for tool in Xvfb xdotool; do
  command -v $tool >/dev/null || {
    leave_out "the window, for want of $tool (as root: apt-get install xvfb xdotool)"
    finish
  }
done
source "$here/screen.sh"
xdotool mousemove 300 400 # over the scene; over a plot it would show values

# looks NAME SCENE ARGUMENT...: the window of 960 by 640 pixels equals the stored picture.
looks() {
  local name=$1 scene=$2 kept=$source_dir/tests/data/shots/window_$1.png
  shift 2
  "$thimble" view "$@" --for 4 --picture "$name.png" 2>"$name.txt" &
  local viewer=$!
  wait_for 60 xdotool search --onlyvisible --name "Thimble: $scene"
  xdotool search --onlyvisible --name "Thimble: $scene" windowsize 960 640
  wait $viewer
  expect 0 '^0$' echo $?
  /usr/bin/python3 "$here/shrink_picture.py" "$name.png" "$name.small.png" 4
  [ -z "${THIMBLE_WRITE_SHOTS:-}" ] || cp "$name.small.png" "$kept"
  expect 0 '^the same' /usr/bin/python3 "$here/picture_near.py" "$kept" "$name.small.png"
}
# Two arms on one ball, their plots over each other, and a signal; then the shorter one has ended.
looks compare stiff stiff.h5 soft.h5 --signals muscle.csv --at 1.6
looks compare_ended stiff stiff.h5 soft.h5 --signals muscle.csv --at 2.6 --theme dark
# Of another scene only the plots are shared, until it is the drawn one.
looks compare_cube stiff stiff.h5 cube.h5 --at 1.6
expect_words 0 'cube.h5 stiff.h5 --scene-of' cat compare_cube.txt
looks compare_scene_of cube stiff.h5 cube.h5 --at 1.6 --scene-of cube.h5
# One recording with a signal keeps its colours.
looks signals stiff stiff.h5 --signals muscle.csv --at 1.6
finish
