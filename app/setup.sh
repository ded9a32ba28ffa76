#!/usr/bin/env bash
# Prepares a Debian 12 machine and builds one preset: installs missing Debian packages, unpacks the
# scanned meshes, configures if the packages have changed since the last time, builds, and lists the optional parts.
# Fast if there is nothing to do.
#   app/setup.sh [PRESET [TARGET...]]    PRESET: release (default), core (the smallest build), dev, clang, asan, asan-all, tsan, tsan-all, coverage
#                                      TARGET: thimble: the program and the Python package, without tests
# THIMBLE_WITHOUT="KEY..." in the environment: optional parts (app/optional_parts.list) that are not installed.
set -euo pipefail
cd "$(dirname "$0")/.."
source app/debian_packages.sh
preset=${1:-release}
targets=("${@:2}")

# Required packages. Those of the optional parts are in app/optional_parts.list.
packages=(
  g++ cmake ninja-build pkg-config       # to build
  libeigen3-dev                          # vectors and matrices
  libusb-1.0-0-dev libhidapi-dev         # arms on USB
  libassimp-dev zlib1g-dev               # meshes: DAE, AMF, 3DS, glTF 1; archives of 3MF
  libpng-dev                             # pictures as height maps
  libyaml-cpp-dev nlohmann-json3-dev     # scenes in, reports out
  libhdf5-dev                            # recordings
  libfmt-dev libspdlog-dev               # text with numbers, the log
  libcli11-dev                           # command line
  libjs-three libjs-dygraphs             # for report pages that replay a run in a browser
  libepoxy-dev libegl-dev libgl-dev      # scenes drawn with OpenGL ...
  libegl-mesa0 libgl1-mesa-dri           # ... in software if there is no graphics card
  libglfw3-dev libimgui-dev              # the window
  libgtest-dev libbenchmark-dev          # tests and benchmarks
)
parts=(base)
[ ${#targets[@]} -gt 0 ] || parts+=(program all)
if [ "$preset" = core ]; then
  packages=(g++ cmake ninja-build pkg-config libeigen3-dev libusb-1.0-0-dev libhidapi-dev zlib1g-dev libpng-dev
    libyaml-cpp-dev nlohmann-json3-dev libfmt-dev libspdlog-dev libcli11-dev)
  parts=()
fi
for i in "${!targets[@]}"; do
  if [ "${targets[i]}" = thimble ]; then
    parts+=(program)
    targets[i]=thimble_product
  fi
done
if [ ${#parts[@]} -gt 0 ]; then
  optional=$(app/optional_parts.sh packages "${parts[@]}")
  mapfile -t -O "${#packages[@]}" packages <<<"$optional"
fi
[ "$preset" != clang ] || packages+=(clang)
[ "$(uname -m)" = x86_64 ] || packages+=(libsimde-dev)  # SSE2's functions on other processors

mapfile -t missing < <(missing_packages "${packages[@]}")
if [ ${#missing[@]} -gt 0 ]; then
  if ! command -v apt-get >/dev/null; then
    echo "This system has no apt-get. Install these Debian packages by hand: ${missing[*]}" >&2
    exit 3
  fi
  echo "Installing Debian packages: ${missing[*]}"
  install_packages "${missing[@]}" || {
    if [ $? = 3 ]; then
      echo "Thimble needs Debian packages that only an administrator can install. Ask an administrator to run:" >&2
    else
      echo "Debian packages could not be installed; see the output of apt-get above. To install them, run:" >&2
    fi
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    echo "To omit optional parts (app/optional_parts.list), run: THIMBLE_WITHOUT=\"KEY...\" app/setup.sh ${*:-}" >&2
    exit 3
  }
fi

# Only tests need the meshes, so they may be missing if targets are named.
[ "$preset" = core ] || app/fetch_meshes.sh || [ ${#targets[@]} -gt 0 ] || exit 3

log=build/$preset.log
mkdir -p build
run() {
  "$@" >>"$log" 2>&1 || {
    tail -n 40 "$log" >&2
    echo "'$*' failed; $log has the complete output." >&2
    exit 4
  }
}
: >"$log"
# CMake searches for packages only during configuration, so configure again if a package was installed or removed.
folder=build/$preset
if [ ! -f "$folder/build.ninja" ] || ! app/optional_parts.sh state | cmp -s - "$folder/optional_packages.txt"; then
  echo "Configuring $folder ..."
  run cmake --preset "$preset"
fi
if [ ${#targets[@]} -gt 0 ]; then
  echo "Building ${targets[*]} ($preset) ..."
  run cmake --build --preset "$preset" --parallel "$(nproc)" --target "${targets[@]}"
else
  echo "Building everything ($preset) ..."
  run cmake --build --preset "$preset" --parallel "$(nproc)"
fi
app/optional_parts.sh table "$folder" base program all
