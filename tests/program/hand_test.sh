#!/usr/bin/env bash
# The keyboard leads the simulated hand in the window, and the touch is audible, on a virtual screen and sound card
# (Debian: xvfb, xdotool, libasound2).
source "$(dirname "$0")/expect.sh" "$@"
unset DISPLAY WAYLAND_DISPLAY
scene=$source_dir/tests/data/scenes/two_boxes.yaml
me=hand$$

# Options that exclude each other are refused, with the correct usage.
expect_words 2 '--rumble --view' "$thimble" run "$scene" --sound
expect_words 2 '--theme --view' "$thimble" run "$scene" --theme dark
expect_words 2 '--clock' "$thimble" run "$scene" --view --clock virtual --sound
expect_words 2 'gamepad simulated' \
  "$thimble" run "$scene" --device auto --hand gamepad
expect_words 2 'gamepad' "$thimble" run "$scene" --hand gamepad --clock virtual

# A recording as sound: a WAV file of the length of the run that is not silent.
expect 0 '' "$thimble" run "$scene" --record touch.h5 --no-view
expect_words 0 'touch.wav 3000' "$thimble" export touch.h5 --sound touch.wav
expect 0 '^288044$' stat -c %s touch.wav # 3 s of 48000 samples of 2 bytes
expect 0 '^yes$' bash -c '[ "$(tail -c +45 touch.wav | tr -d "\0" | wc -c)" -gt 1000 ] && echo yes'
expect_words 2 'touch.wav' "$thimble" export touch.h5 --sound none/touch.wav

for tool in Xvfb xdotool; do
  command -v $tool >/dev/null || {
    leave_out "the keyboard in the window, for want of $tool (as root: apt-get install xvfb xdotool)"
    finish
  }
done
source "$(dirname "$0")/screen.sh"

# A floor below the hand, and a card that writes its samples into a file.
cat >floor.yaml <<END
name: floor
duration: 1
arm: $source_dir/app/arms/vintage_phantom.yaml
objects:
  - {name: floor, plane: {normal: [0, 0, 1]}, position: [0, 0, -0.01], stiffness: 600, damping: 1}
hand:
  path: [{t: 0, at: [0, 0, 0]}, {t: 1, at: [0, 0, 0]}]
END
cat >alsa.conf <<END
pcm.!default {
  type file
  slave.pcm { type null }
  file "$work/played.raw"
  format raw
}
END
ALSA_CONFIG_PATH=$work/alsa.conf "$thimble" run floor.yaml --hand keyboard --sound --rumble --name "$me" --record led.h5 \
  >run.txt 2>&1 &
run=$!
wait_for 60 xdotool search --onlyvisible --name "Thimble: floor"
window=$(xdotool search --onlyvisible --name "Thimble: floor" | head -1)
xdotool windowfocus "$window" 2>/dev/null
# Down to the floor, as often as necessary: the first pictures are slow with software rendering.
touches() {
  xdotool keydown Down
  sleep 0.5
  xdotool keyup Down
  timeout 20 "$thimble" view "$me" --text --for 0.2 | grep -qE 'depth [0-9.]*[1-9]'
}
expect_own 0 '^touched$' bash -c "$(declare -f wait_for touches); thimble='$thimble' me='$me'; wait_for 60 touches && echo touched"
xdotool key BackSpace
expect 0 '' "$thimble" view "$me" --for 2 --hand keyboard --picture window.png
expect 0 '^[0-9]{5,}$' stat -c %s window.png # an empty window takes 11 kB
"$thimble" view "$me" --stop
wait $run
expect 0 '^0$' echo $?
expect 0 'No rumble: no gamepad' cat run.txt
expect_words 0 'led.csv # floor' "$thimble" export led.h5 --csv led.csv
if grep -q 'No sound: built without ALSA' run.txt; then
  echo "NOT TESTED: the sound card, for want of libasound2-dev." >&2
else
  expect 1 '' grep 'No sound' run.txt
  expect 0 '^yes$' bash -c '[ "$(tr -d "\0" <played.raw | wc -c)" -gt 100 ] && echo yes'
fi
finish
