#!/usr/bin/env bash
# Measures the times of a contributor's loops on this machine (CONTRIBUTING.md names them); no pass criterion.
#   tests/bench/loops.sh edit      one changed source of render, driver and app: rebuild in preset dev, run of its tests
#   tests/bench/loops.sh build     the build of app/demo.sh, then of everything, from an empty folder
# Prints elapsed seconds, processor seconds and, for builds, the sum of their steps. No compiler cache is used.
set -euo pipefail
cd "$(dirname "$0")/../.."
export CCACHE_DISABLE=1
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# measure NAME COMMAND...: runs the command and prints its times.
measure() {
  local what=$1
  shift
  local TIMEFORMAT='%R s, processor %U + %S s'
  { time "$@" >"$folder/log" 2>&1 || touch "$folder/failed"; } 2>"$folder/time"
  if [ -e "$folder/failed" ]; then
    tail -n 30 "$folder/log" >&2
    echo "'$*' failed." >&2
    exit 1
  fi
  echo "$what: $(cat "$folder/time")"
}
# step_seconds BUILD_DIR: the sum of all steps of a build.
step_seconds() {
  awk -F'\t' '/^[0-9]/ && !seen[$1 "-" $2 "-" $5]++ { sum += $2 - $1 } END { printf "%.0f", sum / 1000 }' "$1/.ninja_log"
}

case ${1:-} in
  edit)
    app/setup.sh dev >/dev/null
    while read -r source label; do
      touch "$source"
      measure "$source, rebuilt" cmake --build --preset dev --target "tests_$label"
      measure "$source, tests of $label" tests/quick.sh "$label"
    done <<'END'
render/src/track/surface_tracker.cpp render
driver/src/device.cpp driver
app/scene/src/scene_file.cpp app
END
    ;;
  build)
    app/fetch_meshes.sh >/dev/null
    meshes=$PWD/build/meshes
    measure configure cmake --preset release -B "$folder/build" -DTHIMBLE_MESHES="$meshes"
    measure "build of app/demo.sh" cmake --build "$folder/build" --target thimble_demo
    echo "  steps: $(step_seconds "$folder/build") s"
    measure "the rest" cmake --build "$folder/build"
    echo "  steps of all: $(step_seconds "$folder/build") s"
    ;;
  *)
    sed -n '2,5s/^# \{0,1\}//p' "$0"
    exit 2
    ;;
esac
