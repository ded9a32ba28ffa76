#!/usr/bin/env bash
# Breaks one place of driver or render at a time and looks whether a test fails: what survives is a
# fault that no test would see. Writes tests/MUTANTS.md; at least 90 % must be killed.
#   tests/mutate.sh [--short N] [--seed S] [--again FILE:LINE]...
#     --short N   a sample of N mutants, half of them of each library; 300 without it
#     --again     only mutants of that line, and nothing is written
# Works on a copy of the sources in build/mutants. Half a minute of two cores per mutant.
set -euo pipefail
cd "$(dirname "$0")/.."
command -v python3 >/dev/null || {
  echo "tests/mutate.sh needs python3: apt-get install python3" >&2
  exit 3
}
root=$PWD
copy=$root/build/mutants/source
mkdir -p "$copy"
# Whatever a mutant that was interrupted has left is put right; what is the same is not built again.
git ls-files | while IFS= read -r file; do
  [ -f "$file" ] || continue
  cmp -s "$file" "$copy/$file" || install -D "$file" "$copy/$file"
done
cd "$copy"
cmake --preset mutants -DTHIMBLE_MESHES="$root/build/meshes" >configured 2>&1 || {
  cat configured >&2
  exit 1
}
cmake --build build/mutants --target thimble_driver thimble_render test_driver test_wires \
  test_device_sim test_render test_surface test_body test_packed test_render_threads
cd "$root"
exec python3 tests/mutate.py --copy "$copy" --table tests/MUTANTS.md "$@"
