#!/usr/bin/env bash
# Installs what some tests of other makers' interfaces take, if it can; those are skipped otherwise, with a loud line.
set -euo pipefail
packages=(
  g++-aarch64-linux-gnu # builds libraries and programs for 64-bit ARM
  qemu-user             # runs them
)
exec "$(dirname "$0")/../optional_packages.sh" "other makers' interfaces on ARM" "${packages[@]}"
