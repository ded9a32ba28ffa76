#!/usr/bin/env bash
# Pictures without a screen, and errors in their options; then the window, on a virtual
# screen if there is one (Debian: xvfb).
source "$(dirname "$0")/expect.sh" "$@"
scene=$source_dir/app/scenes/water_balloon.yaml

expect 2 '--output FILE.png' "$thimble" shot "$scene"
expect 2 'WIDTHxHEIGHT' "$thimble" shot "$scene" --output a.png --size 10x10
expect 2 'WIDTHxHEIGHT' "$thimble" shot "$scene" --output a.png --size 640
expect_words 2 '--output .png a.jpg' "$thimble" shot "$scene" --output a.jpg
expect_words 2 '--animate .mp4 .gif .png a.jpg' "$thimble" shot "$scene" --animate a.jpg
expect_words 2 '--at 6.5 scene water_balloon 6' "$thimble" shot "$scene" --at 6.5 --output a.png
expect_words 2 '--until 7 scene water_balloon 6' "$thimble" shot "$scene" --at 1 --animate a.png --until 7
expect_error 2 '--until 0.5 1 --at' "$thimble" shot "$scene" --at 1 --animate a.png --until 0.5
expect_error 2 '--until 1 --at' "$thimble" shot "$scene" --at 1 --animate a.png --until 1
expect_error 2 '--until 0 --at' "$thimble" shot "$scene" --animate a.png --until 0
expect 1 '' test -e a.png
for zoom in 0 -1 1e-9 1e9; do
  expect_error 2 '--camera ZOOM 0.01 100' "$thimble" shot "$scene" --at 1 --camera 10 20 $zoom --output a.png
done
expect 2 'no_such.yaml' "$thimble" shot no_such.yaml --output a.png
if ! "$thimble" shot "$scene" --at 1 --size 160x120 --output probe.png >probe.txt 2>&1; then
  if grep -q 'No OpenGL' probe.txt && [ -z "${CI:-}" ]; then
    echo "NOT TESTED: pictures. $(cat probe.txt)"
    exit 77
  fi
fi
expect 0 '' "$thimble" shot "$scene" --at 1 --size 160x120 --plots --edge-planes \
  --shading gouraud --edges on --camera 40 20 --output a.png
expect 0 'PNG' head -c 4 a.png
expect 0 '' "$thimble" shot "$scene" --at 1 --size 160x120 --plots --edge-planes \
  --shading gouraud --edges on --camera 40 20 --output b.png
expect 0 '' cmp a.png b.png  # bit-identical
expect 0 '' "$thimble" shot "$scene" --at 1 --until 1.2 --pace 10 --size 160x120 \
  --animate c.png
expect 0 '^[1-9]' grep -ac fcTL c.png
# Each moment is drawn at its own tick, for objects that dent, that move, and that do neither.
differ() { ! cmp -s "$1" "$2" && echo differ; }
for moving in water_balloon floating_block sandpaper; do
  for at in 2.001 2.007; do
    expect 0 '' "$thimble" shot "$source_dir/app/scenes/$moving.yaml" --at $at --size 320x240 --no-caption \
      --all-colours --output $moving-$at.png
  done
  expect 0 'differ' differ $moving-2.001.png $moving-2.007.png
done
# The shapes that collide are drawn, also of a scene that has none.
if [ -e "$(dirname "$thimble")/thimble-bodies.so" ]; then
  for option in '' --collision; do
    expect 0 '' "$thimble" shot "$source_dir/app/scenes/cans.yaml" --at 1 --size 320x240 $option --output "cans$option.png"
  done
  expect 0 'differ' differ cans.png cans--collision.png
fi
expect 0 '' "$thimble" shot "$scene" --at 1 --size 160x120 --collision --output none.png
# An animation has the requested length, to one unit of its file: the sum of the delays of its pictures.
lasts() {
  python3 - "$1" <<'END'
import struct, sys

data, total, pictures = open(sys.argv[1], 'rb').read(), 0, 0
if data[:4] == b'GIF8':
    flags, at = data[10], 13
    at += 3 << ((flags & 7) + 1) if flags & 128 else 0
    while data[at] != 0x3b:
        if data[at] == 0x21:  # an extension; the graphic control has the delay, in 0.01 s
            if data[at + 1] == 0xf9:
                total += struct.unpack('<H', data[at + 4:at + 6])[0] / 100
                pictures += 1
            at += 2
        else:  # a picture
            flags = data[at + 9]
            at += 11 + (3 << ((flags & 7) + 1) if flags & 128 else 0)
        while data[at]:
            at += 1 + data[at]
        at += 1
else:
    at = 8
    while at < len(data):
        size, name = struct.unpack('>I4s', data[at:at + 8])
        if name == b'fcTL':
            delay, unit = struct.unpack('>HH', data[at + 28:at + 32])
            total += delay / unit
            pictures += 1
        at += 12 + size
print(f'{pictures} pictures last {total:.4f} s')
END
}
film() {  # film FILE UNTIL PACE: from second 1
  expect 0 '' "$thimble" shot "$scene" --at 1 --until "$2" --pace "$3" --size 64x64 --animate "$1"
}
film paced.png 2 60
expect 0 '^60 pictures last 1\.0000 s' lasts paced.png
film paced.png 2 29.97
expect 0 '^30 pictures last 1\.0010 s' lasts paced.png
film paced.png 1.3 10  # 1 + 2 / 10 and 0.3 * 10 are not exact in binary
expect 0 '^3 pictures last 0\.3000 s' lasts paced.png
expect_words 2 '--pace 60 GIF 50' "$thimble" shot "$scene" --at 1 --pace 60 --animate paced.gif
expect_words 2 '--pace 51 GIF' "$thimble" shot "$scene" --at 1 --pace 51 --animate paced.GIF
# Without ffmpeg an error, before anything is drawn.
mkdir -p nothing
expect_words 1 'apt install ffmpeg .png' env PATH="$PWD/nothing" "$thimble" shot "$scene" --at 1 --animate d.mp4
if command -v ffmpeg >/dev/null; then
  # An odd size, which MP4 does not support.
  expect_words 0 'c.mp4 ffmpeg 3 161 121 0.3' "$thimble" shot "$scene" --at 1 --until 1.3 \
    --pace 10 --size 161x121 --animate c.mp4
  expect 0 '^162,122,3$' ffprobe -v error -select_streams v -count_frames -show_entries \
    stream=width,height,nb_read_frames -of csv=p=0 c.mp4
  expect_words 0 'c.gif ffmpeg' "$thimble" shot "$scene" --at 1 --until 1.3 --pace 10 --size 160x120 --animate c.gif
  expect 0 '^GIF89a$' head -c 6 c.gif
  for pace in 50 30; do
    film paced.gif 2 $pace
    expect 0 "^$pace pictures last (0\\.99|1\\.00|1\\.01)00 s" lasts paced.gif
  done
  expect_words 2 'folder no/such/c.gif' "$thimble" shot "$scene" --at 1 --size 160x120 --animate no/such/c.gif
else
  echo "NOT TESTED: MP4 and GIF, for want of ffmpeg."
fi
expect_words 2 'no/such/a.png folder' "$thimble" shot "$scene" --at 1 --size 160x120 --output no/such/a.png
expect 1 'screen' env -u DISPLAY -u WAYLAND_DISPLAY "$thimble" view --for 1

if command -v Xvfb >/dev/null; then
  source "$(dirname "$0")/screen.sh"
  "$thimble" run "$scene" --clock wall --name shot_test_$$ --no-view --duration 60 >run.txt 2>&1 &
  run=$!
  listed() { "$thimble" view --list | grep -q "^$1:"; }
  wait_for 10 listed shot_test_$$
  expect 0 '' "$thimble" view shot_test_$$ --for 2 --picture window.png
  # An empty window takes 11 kB.
  expect 0 '^[0-9]{6,}$' stat -c %s window.png
  kill -INT $run
  wait $run
  expect 0 '' "$thimble" view shot_test_$$ --for 1 --picture none.png  # waits for a run

  # The window does not hold the run's output: a pipe ends with the run, although the window stays open.
  expect 0 'vintage_phantom' timeout 60 bash -c '"$0" run "$1" --duration 1 --view --name "$2" 2>/dev/null | cat' \
    "$thimble" "$scene" shot_pipe_$$
  for viewer in $(pgrep -f "view shot_pipe_$$"); do kill "$viewer"; done
  # A run whose hand was led in a killed window ends as after closing it.
  "$thimble" run "$scene" --hand mouse --name shot_gone_$$ >run.txt 2>&1 &
  run=$!
  for _ in $(seq 200); do
    viewer=$(pgrep -P $run | head -1)
    "$thimble" view --list | grep -q "^shot_gone_$$:" && [ -n "$viewer" ] && break
    sleep 0.1
  done
  kill -9 "$viewer"
  expect 0 '' timeout 30 tail --pid=$run -f /dev/null
  kill -9 $run 2>/dev/null
  # So does a run that restarts for its window.
  "$thimble" run "$scene" --duration 1 --view --loop --name shot_loop_$$ >run.txt 2>&1 &
  run=$!
  for _ in $(seq 200); do
    viewer=$(pgrep -P $run | head -1)
    "$thimble" view --list | grep -q "^shot_loop_$$:" && [ -n "$viewer" ] && break
    sleep 0.1
  done
  kill -9 "$viewer"
  expect 0 '' timeout 30 tail --pid=$run -f /dev/null
  kill -9 $run 2>/dev/null
else
  leave_out 'the window, for want of Xvfb (as root: apt-get install xvfb)'
fi
finish
