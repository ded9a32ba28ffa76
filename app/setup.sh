#!/usr/bin/env bash
# Makes a Debian 12 machine ready and builds one preset: installs the Debian packages that are missing,
# unpacks the scanned meshes, configures, builds. Quick when there is nothing to do.
#   app/setup.sh [PRESET [TARGET...]]      PRESET: release (default), dev, clang, asan, asan-all, tsan, tsan-all,
#                                        coverage
set -euo pipefail
cd "$(dirname "$0")/.."
preset=${1:-release}
targets=("${@:2}")

packages=(
  g++ cmake ninja-build pkg-config       # to build
  libeigen3-dev                          # vectors and matrices
  libusb-1.0-0-dev libhidapi-dev         # arms on USB
  libboost-dev                           # the Inverse3, by its vendor's service (WebSocket); thimble view --web
  libassimp-dev zlib1g-dev               # meshes: DAE, AMF, 3DS, glTF 1; archives of 3MF
  libpng-dev                             # pictures felt as heights
  libyaml-cpp-dev nlohmann-json3-dev     # scenes in, reports out
  libhdf5-dev                            # recordings
  libsqlite3-dev                         # bags of ROS 2
  libfmt-dev libspdlog-dev               # sentences with numbers in them, the log
  libcli11-dev                           # arguments of the program
  gnuplot-nox fonts-dejavu-core          # pictures
  libjs-three libjs-dygraphs             # put into pages that play a touch in a browser
  libepoxy-dev libegl-dev libgl-dev      # scenes drawn with OpenGL ...
  libegl-mesa0 libgl1-mesa-dri           # ... by the processor where there is no graphics card
  libglfw3-dev libimgui-dev              # the window ...
  libasound2-dev                         # ... and what is felt as sound
  libgtest-dev libbenchmark-dev          # tests and benchmarks
)

# What the program alone does not need.
[ ${#targets[@]} -gt 0 ] || packages+=(
  libopenmpi-dev openmpi-bin             # sweeps over several machines
  dpkg-dev file                          # Debian packages
  doxygen                                # the reference of the public headers
  python3-dev pybind11-dev               # the Python package ...
  python3-numpy python3-pytest           # ... and its tests
)

[ "$preset" != release ] || [ ${#targets[@]} -gt 0 ] || packages+=(
  cyclonedds-dev cyclonedds-tools        # topics of ROS 2 ...
  libfastrtps-dev fastddsgen             # ... and a program of another maker that hears them
)
[ "$preset" != clang ] || packages+=(clang)

missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' ||
    missing+=("$package")
done
if [ ${#missing[@]} -gt 0 ]; then
  if ! command -v apt-get >/dev/null; then
    echo "Thimble needs these Debian packages, and this system has no apt-get: ${missing[*]}" >&2
    exit 3
  fi
  if [ "$(id -u)" = 0 ]; then
    as_root=()
  elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
    as_root=(sudo)
  else
    echo "Thimble needs Debian packages that only an administrator can install. Ask one to run:" >&2
    echo "  apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 3
  fi
  echo "Installing Debian packages: ${missing[*]}"
  "${as_root[@]}" apt-get update -q
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
    apt-get install -y -q --no-install-recommends "${missing[@]}"
fi

# Tests need them; who builds a program alone may touch what came with it.
app/fetch_meshes.sh || [ ${#targets[@]} -gt 0 ] || exit 3

log=build/$preset.log
mkdir -p build
run() {
  "$@" >>"$log" 2>&1 || {
    tail -n 40 "$log" >&2
    echo "'$*' failed; the whole output is in $log." >&2
    exit 4
  }
}
: >"$log"
[ -f "build/$preset/build.ninja" ] || run cmake --preset "$preset"
if [ ${#targets[@]} -gt 0 ]; then
  echo "Building ${targets[*]} ($preset) ..."
  run cmake --build --preset "$preset" --parallel "$(nproc)" --target "${targets[@]}"
else
  echo "Building everything ($preset) ..."
  run cmake --build --preset "$preset" --parallel "$(nproc)"
fi
