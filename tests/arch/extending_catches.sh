#!/usr/bin/env bash
# Tests extending.py: it finds each kind of fault in a copy of the guide's pages or of the tree, and none in the unchanged tree.
#   extending_catches.sh SOURCE_FOLDER [BUILD]
set -euo pipefail
source=$(realpath "$1") build=${2:+$(realpath "$2")}
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
mkdir "$scratch/tree"
cd "$scratch/tree"
page=app/guide/pages/extending.md rendering=app/guide/pages/extending_rendering.md
(cd "$source" && cp --parents $page $rendering .clang-format $(python3 tests/arch/extending.py . --files) "$scratch/tree")
failures=0
finds() {  # finds PATTERN FILE SED [BUILD]: extending.py finds the fault that SED makes in FILE
  local status=0
  cp "$2" "$scratch/kept"
  sed -i "$3" "$2"
  ! cmp -s "$2" "$scratch/kept" || { echo "FAILED: $3 changed nothing" && exit 1; }
  python3 "$source/tests/arch/extending.py" . --check ${4:+"$4" law} >"$scratch/said" 2>&1 || status=$?
  if [ $status != 1 ] || ! grep -q "$1" "$scratch/said"; then
    echo "FAILED: not found ($1) after $3 in $2: $(head -c 500 "$scratch/said")"
    failures=$((failures + 1))
  fi
  cp "$scratch/kept" "$2"
}
python3 "$source/tests/arch/extending.py" . --check
finds 'is in 0 lines' render/src/effect/effect_table.cpp 's/"surface\/friction\/dahl.h"/"surface\/friction\/dahls.h"/'
finds 'is in 2 lines' render/CMakeLists.txt 's/^.*friction\/dahl.cpp/&\n&/'
finds 'A friction law: the table must not list - *, must list render/CMakeLists.txt' $rendering '/^| `render\/CMakeLists.txt`/d'
finds 'must say' $rendering 's/^\(| \[a texture\](#a-texture) | \)5/\16/'
finds 'clang-format' $page 's/^  double worst = 0;/   double worst = 0;/'
finds 'there is no file' $page 's/^In `app\/studies\/studies.cpp`/In `app\/studies\/study_list.cpp`/'
finds 'no sentence above says where' $rendering '/^## A tracker/,$s/^Test:$//'
if [ -n "$build" ]; then finds 'does not compile' $rendering 's/SlideTick& tick) noexcept;/SlideTick\& tick);/' "$build"; fi
[ $failures = 0 ] || exit 1
echo "All faults were found."
