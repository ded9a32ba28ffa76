#!/usr/bin/env bash
# Writes the gallery of the shipped scenes: for each scene a page that plays its run and thumbnails, and index.html.
# Each page is one file below 3 MB. Needs no screen.
#   app/guide/gallery.sh [PROGRAM [FOLDER [SCENE...]]]      PROGRAM: build/release/app/thimble by default; FOLDER:
#       build/gallery by default; SCENE: names of shipped scenes, all by default
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
program=${1:-$here/../../build/release/app/thimble}
out=$(realpath -m "${2:-$here/../../build/gallery}")
max_bytes=3000000 # of a page [chosen: loads in 3 s at 8 Mbit/s]
program=$(command -v "$program") || {
  echo "gallery.sh: there is no program ${1:-$program}; build it with app/setup.sh release thimble" >&2
  exit 3
}
program=$(realpath "$program")
scenes=("${@:3}")
[ ${#scenes[@]} -gt 0 ] || mapfile -t scenes < <(basename -s .yaml -a "$here"/../scenes/*.yaml)
mkdir -p "$out"
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
cd "$work"

# thumbnail FILE OPTION...: the scene at its largest force
thumbnail() { "$program" shot "$file" --size 480x320 --no-caption --fields --output "$@" >>said 2>&1; }
failed=0
for scene in "${scenes[@]}"; do
  file=$here/../scenes/$scene.yaml
  "$program" run "$file" --no-view --report "$scene" >said 2>&1 && [ -s "$scene/index.html" ] &&
    thumbnail "$out/$scene.png" && thumbnail "$out/${scene}_dark.png" --theme dark || {
    echo "gallery.sh: the scene $scene was not run:" >&2
    tail -5 said >&2
    failed=1
    continue
  }
  bytes=$(stat -c %s "$scene/index.html")
  [ "$bytes" -lt $max_bytes ] || {
    echo "gallery.sh: the page of $scene has $bytes bytes; the limit is $max_bytes. Shorten the scene's duration." >&2
    failed=1
  }
  mv "$scene/index.html" "$out/$scene.html"
  rm -rf "$scene"
done
[ $failed = 0 ] || exit 1

/usr/bin/python3 - "$out" "${scenes[@]}" <<'INDEX'
"""Writes index.html. Names and descriptions come from the pages."""
import html
import json
import pathlib
import re
import sys

out = pathlib.Path(sys.argv[1])
cards = []
for scene in sys.argv[2:]:
    page = (out / (scene + ".html")).read_text(encoding="utf-8")
    about = json.loads(re.search(r'<script type="application/json" id="about">(.*?)</script>', page, re.S).group(1))
    cards.append(f'<li><a href="{scene}.html"><picture><source srcset="{scene}_dark.png" media="(prefers-color-scheme: dark)">'
                 f'<img src="{scene}.png" alt="" width="480" height="320" loading="lazy"></picture>'
                 f'<h2>{html.escape(about["title"])}</h2><p>{html.escape(about["subtitle"])}</p></a></li>')
(out / "index.html").write_text(f"""<!doctype html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>Thimble - gallery of scenes</title>
<link rel="icon" href="data:,">
<style>
:root {{ color-scheme: light dark; --ink: #1f2933; --quiet: #5b6875; --paper: #fff; --card: #f5f7f9; --line: #dde2e7; }}
@media (prefers-color-scheme: dark) {{ :root {{ --ink: #e3e8ed; --quiet: #98a5b3; --paper: #14191f; --card: #1a2027; --line: #2c353f; }} }}
body {{ margin: 0 auto; max-width: 1240px; padding: 20px; font: 15px/1.5 "DejaVu Sans", system-ui, sans-serif; color: var(--ink); background: var(--paper); }}
h1 {{ font-size: 24px; margin: 0; }} header p {{ color: var(--quiet); margin: 4px 0 18px; max-width: 46em; }}
ul {{ list-style: none; margin: 0; padding: 0; display: grid; grid-template-columns: repeat(auto-fill, minmax(270px, 1fr)); gap: 16px; }}
li a {{ display: block; height: 100%; border: 1px solid var(--line); border-radius: 9px; overflow: hidden; background: var(--card); color: inherit; text-decoration: none; }}
li a:hover, li a:focus-visible {{ border-color: #4a90c2; box-shadow: 0 2px 12px rgba(11, 60, 93, 0.25); }}
img {{ display: block; width: 100%; height: auto; }}
h2 {{ font-size: 15px; margin: 10px 14px 2px; }} li p {{ font-size: 13px; color: var(--quiet); margin: 0 14px 12px; }}
</style>
</head>
<body>
<header>
<h1>Scenes that come with Thimble</h1>
<p>Each page plays a run of a scene: objects, path of the tip, forces. All ticks are computed by Thimble with a simulated arm.
Run a scene yourself with <code>thimble run NAME --view</code>.</p>
</header>
<ul>
{chr(10).join(cards)}
</ul>
</body>
</html>
""", encoding="utf-8")
INDEX
echo "${#scenes[@]} scenes, largest page $(stat -c %s "$out"/*.html | sort -n | tail -1) bytes: $out/index.html"
