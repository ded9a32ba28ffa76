#!/usr/bin/env bash
# Unpacks the scanned meshes of Debian's libcgal-demo package (its data archive, about 140 meshes) into
# build/meshes. Uses the installed package's archive, or downloads the package file: nothing is installed, and no
# privileges are needed.
#   app/fetch_meshes.sh
set -euo pipefail
cd "$(dirname "$0")/.."
[ -f build/meshes/elephant.off ] && exit 0
mkdir -p build
work=$(mktemp -d build/meshes.XXXXXX)
trap 'rm -rf "$work"' EXIT
installed=/usr/share/doc/libcgal-dev/data.tar.gz
if [ -f $installed ]; then
  tar -xzf $installed -C "$work" data/meshes
  rm -rf build/meshes
  mv "$work/data/meshes" build/meshes
  exit 0
fi
echo "Fetching the meshes of Debian's libcgal-demo package ..."
if ! (cd "$work" && apt-get download -q libcgal-demo) >"$work/log" 2>&1; then
  tail -n 3 "$work/log" >&2
  echo "The package libcgal-demo could not be downloaded. Run 'apt-get update' as root, check the" >&2
  echo "network, and try again; or put its data/meshes/*.off into build/meshes yourself." >&2
  exit 3
fi
dpkg-deb --fsys-tarfile "$work"/libcgal-demo_*.deb |
  tar -xO ./usr/share/doc/libcgal-dev/data.tar.gz | tar -xz -C "$work"
mv "$work/data/meshes" "$work/ready"
rm -rf build/meshes
mv "$work/ready" build/meshes
