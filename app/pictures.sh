#!/usr/bin/env bash
# Draws the animation of README.md into app/pictures: the first touch of a shipped scene, with force and depth.
# Needs no screen, and ffmpeg.
#   app/pictures.sh [PROGRAM]      PROGRAM: build/release/app/thimble by default, which is built
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || app/setup.sh release thimble
program=${1:-build/release/app/thimble}
out=app/pictures/first_touch.gif
max_bytes=1500000 # [chosen: loads in 1.5 s at 8 Mbit/s]

"$program" shot app/scenes/elephant.yaml --at 0.6 --until 5.4 --pace 16 --size 720x520 --no-caption --trail --plots --animate $out
[ "$(stat -c %s $out)" -lt $max_bytes ] || {
  echo "pictures.sh: $out has $(stat -c %s $out) bytes; the limit is $max_bytes. Shorten the animation or make it smaller." >&2
  exit 1
}
