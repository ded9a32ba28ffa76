#!/usr/bin/env bash
# Unpacks the meshes of other makers in Debian packages into a folder, for WorldForeign (tests/CHECKS.md). Nothing is
# installed, and no privileges are needed. Packages take about 290 MB to download.
#   tests/foreign_meshes.sh FOLDER
set -euo pipefail
if [ $# != 1 ] || [[ $1 == -* ]]; then
  echo "usage: tests/foreign_meshes.sh FOLDER" >&2
  exit 2
fi
packages=(libcgal-demo assimp-testmodels cura prusa-slicer openscad meshlab freecad-common sweethome3d-furniture)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
endings=(--ignore-case --wildcards '*.off' '*.obj' '*.stl' '*.ply' '*.gltf' '*.glb' '*.bin' '*.3mf' '*.dae' '*.amf' '*.3ds'
  '*.sh3f' '*data.tar.gz')
for package in "${packages[@]}"; do
  if ! (cd "$work" && apt-get download -q "$package") >"$work/log" 2>&1; then
    tail -n 3 "$work/log" >&2
    echo "The package $package could not be downloaded. Run 'apt-get update' as root, check the network, and try again." >&2
    exit 3
  fi
  mkdir -p "$folder/$package"
  # tar fails if one of the patterns matches nothing.
  dpkg-deb --fsys-tarfile "$work/$package"_*.deb | tar -x -C "$folder/$package" "${endings[@]}" 2>/dev/null || true
  rm "$work/$package"_*.deb
  # Archives in packages: scans of CGAL, catalogues of Sweet Home 3D.
  find "$folder/$package" -name 'data.tar.gz' -execdir tar -xzf '{}' data/meshes \; -delete
  find "$folder/$package" -name '*.sh3f' -print0 | while IFS= read -r -d '' catalogue; do
    python3 - "$catalogue" <<'END'
import pathlib, sys, zipfile

catalogue = pathlib.Path(sys.argv[1])
with zipfile.ZipFile(catalogue) as files:
    for name in files.namelist():
        if name.lower().endswith(".obj"):
            files.extract(name, catalogue.with_suffix(""))
END
    rm "$catalogue"
  done
  echo "$package: $(find "$folder/$package" -type f | wc -l) files"
done
