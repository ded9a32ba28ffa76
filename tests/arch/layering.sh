#!/usr/bin/env bash
# Fails if a room includes what it must not know (the table in README.md).
#   tests/arch/layering.sh [SOURCE_DIR]
set -euo pipefail
cd "${1:-$(dirname "$0")/../..}"
bad=0

# forbid ROOM PATTERN WHY: no include in ROOM may match PATTERN (an extended regular expression).
forbid() {
  local found
  if found=$(grep -rnE "^[[:space:]]*#[[:space:]]*include[[:space:]]*[<\"]($2)" "$1"); then
    echo "$1 must not know $3:"
    echo "$found" | sed 's/^/  /'
    bad=1
  fi
}

graphics='GL/|GLFW|imgui|EGL/|epoxy/'
forbid driver "thimble/(device_sim|render|app)/|$graphics|spdlog/|yaml-cpp/|CLI/" \
  "other rooms, graphics, logging or files"
forbid driver/include 'libusb|hidapi|termios' "a bus library in a public header"
forbid device_sim "thimble/(render|app)/|$graphics|spdlog/|yaml-cpp/|CLI/" \
  "render, app, graphics, logging or files"
forbid device_sim 'thimble/driver/(device|safety_gate|servo_loop|velocity_estimator|real_time)\.h' \
  "the host's side of the driver: it meets it at the wire only"
forbid render "thimble/(device_sim|app)/|$graphics|spdlog/|yaml-cpp/|CLI/" \
  "device_sim, app, graphics, logging or scene files"
forbid render 'thimble/driver/(transport|device|arm|arms/.*|clock|servo_loop|real_time)\.h|thimble/driver/arms/' \
  "the wire or the arm: a force law knows state and force only"

exit $bad
