#!/usr/bin/env bash
# Draws the picture of README.md into app/pictures: a moment of a shipped scene.
# Needs no screen.
set -euo pipefail
cd "$(dirname "$0")/.."
app/setup.sh release thimble
shot() { build/release/app/thimble shot "app/scenes/$1.yaml" "${@:2}"; }
out=app/pictures

shot elephant --at 1.5 --size 900x600 --out $out/elephant.png
