#!/usr/bin/env bash
# readme_files.py and renamed_names.py find planted faults.
#   readme_files_catches.sh SOURCES
set -euo pipefail
check=$(cd "$1" && pwd)/tests/arch
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "readme_files_catches: $1" >&2
  exit 1
}
git -C "$work" init -q 2>/dev/null || { echo "git is missing" && exit 77; }
mkdir -p "$work/driver/src" "$work/driver/include/thimble"
touch "$work/driver/src/seen.cpp" "$work/driver/src/other_name.h"
map() {
  printf '# driver\n\n| files | contents |\n|---|---|\n%s\n' "$1" >"$work/driver/src/README.md"
  git -C "$work" add -A
}
finds() {  # finds TEXT: the check fails with this text
  ! python3 "$check/readme_files.py" "$work" >"$work.said" || fail "accepted: $1"
  grep -q "$1" "$work.said" || fail "does not report: $1: $(cat "$work.said")"
  rm "$work.said"
}
map '| `seen`, `other_name.h` | all |'
python3 "$check/readme_files.py" "$work" >/dev/null || fail "refuses a complete map"
map '| `seen`, `other_*` | all |'
python3 "$check/readme_files.py" "$work" >/dev/null || fail "refuses a pattern"
map '| `seen`, `other_name.h`, `gone` | all |'
finds 'README.md:5: gone does not exist'
map '| `seen` | all |'
finds 'lacks other_name.h'

# A deprecated name and a renamed key that the page of the API does not list.
mkdir -p "$work/app/guide/pages" "$work/app/scene/src"
cp -r "$1/app/scene/src/yaml" "$work/app/scene/src/yaml"
mkdir -p "$work/render"
cp -r "$1/driver/include" "$work/driver/" && cp -r "$1/render/include" "$work/render/"
for name in kForceMost Touch grain; do
  grep -v "$name\`" "$1/app/guide/pages/api.md" >"$work/app/guide/pages/api.md"
  ! python3 "$check/renamed_names.py" "$work" >"$work.said" || fail "accepted a page without $name"
  grep -q "lacks $name, " "$work.said" || fail "does not report $name: $(cat "$work.said")"
done
cp "$1/app/guide/pages/api.md" "$work/app/guide/pages/api.md"
python3 "$check/renamed_names.py" "$work" >/dev/null || fail "refuses the page of this tree"
rm -f "$work.said"
echo "readme_files_catches: passed"
