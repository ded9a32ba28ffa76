#!/usr/bin/env bash
# Redraws the pictures of README.md into app/pictures: each is a moment of a shipped scene.
# Needs no screen.
set -euo pipefail
cd "$(dirname "$0")/.."
app/setup.sh release thimble
shot() { build/release/app/thimble shot "app/scenes/$1.yaml" "${@:2}"; }
out=app/pictures

shot elephant --at 1.5 --size 900x600 --out $out/elephant.png
shot water_balloon --at 0.6 --until 3.2 --pace 12 --size 480x360 --no-caption --animate $out/dent.png
shot soft_coarse --size 480x360 --no-caption --out $out/soft_coarse.png
shot tin_can --at 5 --camera 25 40 --size 480x360 --no-caption --out $out/tin_can.png
