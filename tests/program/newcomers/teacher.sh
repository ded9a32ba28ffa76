#!/usr/bin/env bash
# A teacher in class: a run that others follow as text, a page for any browser, a picture, an animation.
source "$(dirname "$0")/follow.sh"

says guide/viewer.md '`thimble view RUN --text` prints to the terminal and needs no screen'
thimble run clay --clock wall --duration 60 --name class_$$ --no-view --record clay.h5 >run.txt 2>&1 &
run=$!
for _ in $(seq 100); do
  if thimble view --list | grep -q "^class_$$:"; then break; fi
  sleep 0.1
done
see 'running: .* N' thimble view class_$$ --text --for 3
see '' thimble view class_$$ --stop
wait $run || fail "the run ended with $?: $(cat run.txt)"
see 'stopped early' cat run.txt

says guide/recording.md 'It is one file and loads no other. You can mail it or put it on a web server.'
says guide/recording.md 'thimble replay tin_can.h5 --page can.html'
thimble run clay --duration 3 --record class.h5 >said 2>&1 || fail "$(cat said)"
thimble replay class.h5 --page class.html >said 2>&1 || grep -q 'libjs-three' said || fail "$(cat said)"
if [ -e class.html ]; then
  grep -E '<(script|link)[^>]* (src|href)=' class.html | grep -qv 'href="data:' && fail "the page loads something"
else
  echo "  NOT TESTED: the page; libjs-three and libjs-dygraphs are missing."
fi

# An arm with two motors, and a surface that feels harder than its spring.
says guide/effects.md '`thimble study accuracy --axis hardness` shows how much harder it makes a wall of a given stiffness'
see 'the simulated arm haply_2diy_3' thimble run disc --arm haply_2diy_3 --duration 1
cat >tapped.yaml <<'END'
name: tapped
arm: vintage_phantom
duration: 1
objects:
  - name: ball
    sphere: {radius: 0.025}
    position: [0, 0, -0.025]
    stiffness: 600
    effects:
      - {contact: transient, gain: 12, frequency: 150, decay: 0.01}
hand:
  path:
    - {t: 0, at: [0, 0, 0.01]}
    - {t: 0.3, on: ball, near: [0, 0, 0], press: 0.003}
END
see '^Force' thimble run tapped.yaml

says guide/commands.md 'draws a moment of a scene without a screen'
if ! thimble shot clay --at 2 --size 160x120 --output clay.png >said 2>&1; then
  grep -q 'No OpenGL' said || fail "$(cat said)"
  echo "  NOT TESTED: pictures. $(cat said)"
  exit 0
fi
see PNG head -c 4 clay.png
says guide/recording.md 'this command makes an animation'
animate() { thimble shot clay --at 2 --until 2.5 --pace 8 --size 160x120 --animate "$1"; }
see 'Animation: clay_film\.png \(animated PNG, 4 pictures' animate clay_film.png
if has ffmpeg; then
  see 'Animation: clay\.mp4 \(by ffmpeg, 4 pictures' animate clay.mp4
else
  animate clay.mp4 >said 2>&1 && fail "an MP4 without ffmpeg: $(cat said)"
  see 'apt install ffmpeg' cat said
fi
