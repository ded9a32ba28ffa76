#!/usr/bin/env bash
# Applies each addition of the guide's pages app/guide/pages/extending*.md to a copy of the tree, builds it, runs the
# commands below it, and checks that only the files changed that its section lists.
#   tests/extending.sh [WORD...]    WORD: the last of a section's heading (arm, key, study, command, law, texture, tracker);
#                                   by default all of them, on top of each other
# THIMBLE_EXTENDING: the folder of the copy, build/extending by default. Builds of an earlier call are reused.
set -euo pipefail
source=$(cd "$(dirname "$0")/.." && pwd)
copy=${THIMBLE_EXTENDING:-$source/build/extending}
page() { python3 "$source/tests/arch/extending.py" "$source" "$@"; }
[ $# -gt 0 ] && words=("$@") || mapfile -t words < <(page)
for word in "${words[@]}"; do page --test "$word" >/dev/null; done

# Only files that differ are copied, so that Ninja builds no more than necessary.
mkdir -p "$copy"
cd "$copy"
in_copy() { git -C "$copy" -c user.name=extending -c user.email=extending@localhost "$@"; }
[ -d .git ] || in_copy init -q
page --copy "$copy"
in_copy add -A
in_copy commit -q --allow-empty -m "the tree as it is"
[ -e build/release/build.ninja ] || {
  echo "Configuring $copy ..."
  cmake --preset release -D "THIMBLE_MESHES=$source/build/meshes" >configure.log 2>&1 || { tail -n 30 configure.log >&2; exit 1; }
  rm configure.log
}

failed=()
for word in "${words[@]}"; do
  begin=$SECONDS
  if page --apply "$word" "$copy" &&
    page --test "$word" | (
      number=0
      while read -r line; do
        number=$((number + 1))
        bash -c "set -o pipefail; $line" </dev/null >"build/extending_$word.$number.log" 2>&1 || {
          echo "FAILED: $word: $line" >&2
          tail -n 40 "build/extending_$word.$number.log" >&2
          exit 1
        }
      done
    ) && bash tests/arch/layering.sh "$copy" && bash tests/arch/citations.sh "$copy" && page --changed "$word" "$copy"; then
    echo "$word: $(in_copy status --porcelain --untracked-files=all | wc -l) files, $((SECONDS - begin)) s"
    in_copy add -A
    in_copy commit -q -m "$word"
  else
    failed+=("$word")
    in_copy checkout -q .
    in_copy clean -fdq
  fi
done
[ ${#failed[@]} = 0 ] || { echo "FAILED: ${failed[*]}" >&2; exit 1; }
echo "${#words[@]} additions are as the pages say."
