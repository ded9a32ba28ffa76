#!/usr/bin/env bash
# Runs every command of the guide and the README (guide_commands.sh), and checks that the pages agree with
# the program and the sources.
#   guide_test.sh PROGRAM SOURCE_FOLDER WORK_FOLDER
set -euo pipefail
program=$1 source=$2 work=$3
rm -rf "$work"
mkdir -p "$work/bin"
ln -s "$program" "$work/bin/thimble"
ln -s "$source/app" "$work/app"
export PATH=$work/bin:$PATH
# The Python package of this build, if there is one, with its Python version.
python=$(dirname "$program")/python
if [ -d "$python/thimble" ] && /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
  ln -s /usr/bin/python3 "$work/bin/python3"
  export PYTHONPATH=$python PYTHONDONTWRITEBYTECODE=1
else
  python=
  echo "NOT TESTED: the guide's Python; the package was not built, or numpy is missing."
fi
cd "$work"

commands=0
bash "$(dirname "$0")/guide_commands.sh" "$source" >commands
while IFS=$'\t' read -r page line; do
  if [[ $line == "python3 "* ]] && [ -z "$python" ]; then continue; fi
  commands=$((commands + 1))
  bash -c "$line" </dev/null >said 2>&1 || grep -q 'Without python3-matplotlib' said || {
    echo "FAILED: $page: $line" >&2
    cat said >&2
    exit 1
  }
done <commands
grep -q $'^README.md\tthimble run tin_can --record can.h5$' commands ||
  { echo "FAILED: no command of the README was found" >&2 && exit 1; }
[ "$commands" -ge 12 ] || { echo "FAILED: only $commands commands were found" >&2 && exit 1; }
echo "$commands commands of $(cut -f 1 commands | sort -u | wc -l) pages ran."

# The guide's Python code, all of it in one run.
if [ -n "$python" ]; then
  awk '/^```python$/ { inside = 1; next } /^```/ { inside = 0 } inside' \
    "$source/app/guide/pages/python.md" >guide.py
  [ "$(grep -c 'import thimble' guide.py)" -ge 5 ] || { echo "FAILED: the guide's Python is gone" >&2 && exit 1; }
  python3 guide.py >said 2>&1 || { echo "FAILED: the guide's Python" >&2 && cat said >&2 && exit 1; }
fi

# The guide's scenes; the bowl is one that no repair closes.
awk -v to="$work" '/^```yaml$/ { inside = 1; next } /^```/ { inside = 0; out = "" } inside && /^name: / { out = to "/" $2 ".yaml" }
  out != "" { print >out }' "$source/app/guide/pages/scenes.md"
sed -i "s|\.\./arms|$source/app/arms|" my_*.yaml
printf 'OFF\n5 4 0\n1 1 1\n-1 1 1\n-1 -1 1\n1 -1 1\n0 0 0.6\n3 0 1 4\n3 1 2 4\n3 2 3 4\n3 3 0 4\n' >bowl.off
for scene in my_ball my_block my_bowl; do
  thimble run $scene.yaml >said 2>&1 || { echo "FAILED: the guide's scene $scene" >&2 && cat said >&2 && exit 1; }
done
grep -qE ' sheet .*4 triangles' said || { echo "FAILED: the sheet is not reported" >&2 && exit 1; }

# The page of all keys equals the list of the readers.
bash "$source/app/guide/keys.sh" thimble | diff "$source/app/guide/pages/keys.md" - ||
  { echo "FAILED: app/guide/pages/keys.md is old; app/guide/keys.sh writes it" >&2 && exit 1; }

# Each friction, texture and field that a scene can name has a row on the page of effects. Joints and collisions have a
# friction that is a number.
for group in friction texture field; do
  thimble help scene $group | sed -nE "s/^ *$group +(.*); .*/\1/p" | grep -v '^a number' | sed 's/, /\n/g; s/ or /\n/g' >names
  [ "$(wc -l <names)" -ge 3 ] || { echo "FAILED: thimble help scene $group names hardly any" >&2 && exit 1; }
  while read -r name; do
    grep -q "^|.*\`$name\`" "$source/app/guide/pages/effects.md" ||
      { echo "FAILED: app/guide/pages/effects.md has no row for the $group $name" >&2 && exit 1; }
  done <names
done

# The guide's figures of peers equal those in the folders of the sources: hot ticks, ticks in the loop, and
# times of searches.
compare=$source/app/guide/pages/compare.md packed=$source/render/src/compact_mesh/README.md
hot() { sed -nE 's/^\| (10\^[0-9])[^|]*\| ([0-9]+), [0-9]+ \(([0-9]+), [0-9]+\) \| ([0-9]+), [0-9]+ \(([0-9]+), [0-9]+\) \|.*/| \1 | \2 | \3 | \4 | \5 |/p'; }
in_the_loop() { grep -E '^\| 10\^[0-9] (\| [0-9]+, [0-9]+ ){3}\| [0-9.]+, [0-9.]+ \|$'; }
peers_of() { grep -E "^\| $1" "$2" | grep -oE '\([0-9]+\)'; } # ROW FILE
hot <"$packed" >measured
[ "$(wc -l <measured)" = 5 ] || { echo "FAILED: render/src/compact_mesh/README.md has no table of peers" >&2 && exit 1; }
grep -E '^\| 10\^[0-9] (\| [0-9]+ ){4}\|$' "$compare" | diff - measured ||
  { echo "FAILED: compare.md gives other times of ticks than render/src/compact_mesh/README.md" >&2 && exit 1; }
in_the_loop <"$packed" >measured
[ "$(wc -l <measured)" = 5 ] || { echo "FAILED: render/src/compact_mesh/README.md has no table of the loop" >&2 && exit 1; }
in_the_loop <"$compare" | diff - measured ||
  { echo "FAILED: compare.md gives other times in the loop than render/src/compact_mesh/README.md" >&2 && exit 1; }
for row in 'ball, segment' 'torus, segment' 'ball, nearest point' 'torus, nearest point'; do
  peers_of "$row" "$source/render/src/search/README.md" >measured
  [ "$(wc -l <measured)" = 4 ] || { echo "FAILED: render/src/search/README.md has no row: $row" >&2 && exit 1; }
  peers_of "$row" "$compare" | diff - measured ||
    { echo "FAILED: compare.md gives other times of searches than render/src/search/README.md: $row" >&2 && exit 1; }
done

# The animation of the README: app/pictures.sh draws it, below 1.5 MB.
animation=$(sed -nE 's/^!\[.*\]\((app\/pictures\/.*\.gif)\)$/\1/p' "$source/README.md")
[ -n "$animation" ] && [ "$(stat -c %s "$source/$animation")" -lt 1500000 ] && grep -qF "${animation##*/}" "$source/app/pictures.sh" ||
  { echo "FAILED: the README has no animation below 1.5 MB that app/pictures.sh draws" >&2 && exit 1; }

# The guide as a site, strictly: no dead link, no page outside the menu.
bash "$source/app/guide/site.sh" "$work/pages" || {
  [ $? = 3 ] || { echo "FAILED: the guide's pages" >&2 && exit 1; }
  echo "NOT TESTED: the guide as web pages; install mkdocs."
}
