#!/usr/bin/env bash
# Unpacks Debian's packages of Thimble's libraries for 64-bit ARM into a folder. Uses a separate list and cache of
# apt, so that nothing of this system changes and no administrator is needed.
#   tests/arm64_sysroot.sh FOLDER
set -euo pipefail
[ $# = 1 ] || { sed -n '2,4s/^# \{0,1\}//p' "$0" && exit 2; }
mkdir -p "$1"
root=$(cd "$1" && pwd)
packages=(
  libc6-dev libstdc++-12-dev
  libeigen3-dev libusb-1.0-0-dev libhidapi-dev libboost-dev libassimp-dev zlib1g-dev libpng-dev libyaml-cpp-dev
  nlohmann-json3-dev libhdf5-dev libsqlite3-dev libbullet-dev libfmt-dev libspdlog-dev libcli11-dev libepoxy-dev libegl-dev
  libgl-dev libglfw3-dev libimgui-dev libasound2-dev libgtest-dev libbenchmark-dev libmpfr-dev libsimde-dev
)
[ "$(cat "$root/packages" 2>/dev/null)" != "${packages[*]}" ] || exit 0

mkdir -p "$root"/apt/{lists,archives,preferences.d}/partial "$root/usr"
: >"$root/apt/status"
apt() {
  apt-get -q -o APT::Architecture=arm64 -o APT::Architectures=arm64 -o Dir::State="$root/apt" \
    -o Dir::State::Lists="$root/apt/lists" -o Dir::State::status="$root/apt/status" -o Dir::Cache="$root/apt" \
    -o Dir::Cache::Archives="$root/apt/archives" -o APT::Sandbox::User= -o APT::Install-Recommends=false \
    -o APT::Keep-Downloaded-Packages=true "$@"
}
apt update >"$root/apt/log" && apt install -y --download-only "${packages[@]}" >>"$root/apt/log" || {
  tail -n 5 "$root/apt/log" >&2
  exit 1
}
# As in Debian since 12: /lib is /usr/lib.
for folder in bin sbin lib; do
  mkdir -p "$root/usr/$folder"
  ln -sfn "usr/$folder" "$root/$folder"
done
for package in "$root"/apt/archives/*.deb; do
  dpkg-deb --fsys-tarfile "$package" |
    tar -x -C "$root" --keep-directory-symlink --exclude=./usr/share/doc --exclude=./usr/share/man --exclude=./usr/share/locale
done
# The cross compiler does not rewrite links of a sysroot: absolute ones would point outside of it.
find "$root/usr" -type l -lname '/*' -printf '%p\t%l\n' | while IFS=$'\t' read -r link to; do
  ln -sfn "$(realpath -m --relative-to="$(dirname "$link")" "$root$to")" "$link"
done
# The choice that an installation would have made.
ln -sfn hdf5-serial.pc "$root/usr/lib/aarch64-linux-gnu/pkgconfig/hdf5.pc"
# CMake's package files also name libraries by absolute paths.
find "$root"/usr/lib/*/cmake -name '*.cmake' -exec sed -Ei 's#([";:])/usr/#\1${CMAKE_SYSROOT}/usr/#g' {} +
rm -rf "$root/apt/archives"
echo "${packages[*]}" >"$root/packages"
