#!/usr/bin/env bash
# Demo: installs and builds Thimble, runs a simulated PHANTOM-class arm with a simulated hand that touches a
# scanned elephant for 10 s at 1 kHz, and draws pictures of the run. If the scan is unavailable, the hand
# touches a balloon, whose mesh is part of Thimble.
#   app/demo.sh [options of `thimble run`]      for example: app/demo.sh --duration 3
set -euo pipefail
cd "$(dirname "$0")/.."
app/setup.sh release thimble_demo
scene=elephant
if [ ! -f build/meshes/elephant.off ]; then scene=water_balloon; fi
exec build/release/app/demo/thimble run app/scenes/$scene.yaml --device sim --clock wall \
  --report build/demo "$@"
