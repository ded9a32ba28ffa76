#!/usr/bin/env bash
# Builds the guide as web pages with mkdocs (Debian: mkdocs). Dead links and pages that are in no menu
# are errors.
#   app/guide/site.sh [FOLDER [PROGRAM]]      FOLDER: where to write, build/guide by default; open index.html there.
#       PROGRAM: also writes the gallery of the shipped scenes (app/guide/gallery.sh), about 50 MB
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
out=$(realpath -m "${1:-$here/../../build/guide}")
command -v mkdocs >/dev/null || {
  echo "mkdocs is not installed: apt install mkdocs" >&2
  exit 3
}
said=$(mkdocs build --clean --strict -f "$here/mkdocs.yml" -d "$out" 2>&1) || {
  echo "$said" >&2
  exit 1
}
# mkdocs only reports pages that are in no menu, and does not check whether a heading exists.
failed=0
if grep -A 20 'not included in the "nav"' <<<"$said" >&2; then failed=1; fi
while IFS=$'\t' read -r page target; do
  file=${target%%#*} anchor=${target#*#}
  [ -n "$file" ] && file=$(dirname "$page")/$file || file=$page
  grep -q "id=\"$anchor\"" "$file" || {
    echo "${page#"$out"/}: there is no heading #$anchor in ${file#"$out"/}" >&2
    failed=1
  }
done < <(grep -oHP '<a [^>]*href="\K[^":]*#[^"]+(?=")' "$out"/*.html | sed 's/:/\t/' | grep -v '#$' | sort -u)
# Each picture must be shown on a page.
for picture in "$here"/pages/pictures/*; do
  grep -rqF "pictures/$(basename "$picture")" "$here"/pages/*.md || {
    echo "app/guide/pages/pictures/$(basename "$picture"): no page shows it" >&2
    failed=1
  }
done
[ $failed = 0 ] || exit 1
# The gallery, or a page that says how to make it, so that the link to it is never dead.
if [ $# -gt 1 ]; then
  bash "$here/gallery.sh" "$2" "$out/gallery"
else
  mkdir -p "$out/gallery"
  echo '<!doctype html><html lang="en"><meta charset="utf-8"><title>Gallery</title><p>This copy of the guide has no gallery. <code>app/guide/gallery.sh</code> writes it; <a href="../gallery.html">back</a>.</p></html>' >"$out/gallery/index.html"
fi
echo "$(ls "$out"/*.html | wc -l) pages: $out/index.html"
