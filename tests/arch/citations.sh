#!/usr/bin/env bash
# Each key in square brackets in a comment or a document is in the guide's references. Each cited section
# of the physics and of the arms exists, and so does each test that a page names. Names of tests
# (Suite.Name) have at most 60 characters, and each suite of hard cases has its number in tests/acceptance/hard_cases.list.
#   citations.sh SOURCE_FOLDER
set -euo pipefail
source=$1
pages=app/guide/pages
cd "$source"
keys=$(grep -oP '^\| \[\K[A-Za-z]+(?=\])' $pages/references.md)
[ "$(wc -w <<<"$keys")" -ge 10 ] || { echo "FAILED: $pages/references.md has no keys" >&2 && exit 1; }

# file:line:comment of every comment, and of every line of a document outside its code.
comments() {
  find CMakeLists.txt README.md CONTRIBUTING.md app device_sim driver render tests udev -type f \
    \( -name '*.h' -o -name '*.cpp' -o -name '*.c' \) -print0 | xargs -0 grep -nHoP '//.*'
  find CMakeLists.txt app driver tests udev -type f \
    \( -name '*.yaml' -o -name CMakeLists.txt -o -name '*.sh' -o -name '*.py' -o -name '*.rules' \) -not -path 'tests/fuzz/*' \
    -print0 | xargs -0 grep -nHoP '(^|\s)#.*'
  find README.md CONTRIBUTING.md app device_sim driver render tests -type f -name '*.md' -not -name references.md -print0 |
    xargs -0 awk '/^ *```/ { inside = !inside; next } !inside && !/^    / { gsub(/`[^`]*`/, ""); print FILENAME ":" FNR ":" $0 }'
}
# A citation is not an index, an argument of a function, a link, or an option of a usage line.
cited=$(comments | grep -P '(?<![A-Za-z0-9_`\]):])\[[A-Z][A-Za-z]*[ \],:]' |
  perl -ne 'my ($at, $text) = /^([^:]*:[0-9]*):(.*)/;
    while ($text =~ /(?<![A-Za-z0-9_`\])])\[([A-Z][A-Za-z]*)((?:[ ,:][^\]`(]*)?)\](?![(\[])/g) { print "$at\t$1\t$2\n" }')
[ "$(wc -l <<<"$cited")" -ge 100 ] || { echo "FAILED: fewer than 100 citations were found" >&2 && exit 1; }

failed=0
while IFS=$'\t' read -r at key rest; do
  # Options of a usage line and units in a diagram are capitals as well.
  case $key in ARM | BUILD | FILE | FIRMWARE | FOLDER | NAME | OUTPUT | PICTURE | PRESET | PROGRAM | REGEX | SCENE | THREADS | TIMEOUT | APART | HARD_CASES) continue ;; esac
  if ! grep -qx "$key" <<<"$keys"; then
    echo "$at: [$key$rest] is not in $pages/references.md"
    failed=1
  fi
  case $key in
    PHYSICS) cited_pages=("$pages/physics.md" "$pages/physics_effects.md") ;;
    DEVICES) cited_pages=("$pages/devices.md") ;;
    *) continue ;;
  esac
  sections=$(grep -oP '(?<![A-Za-z0-9.])[0-9](\.[0-9])?(?![0-9A-Za-z])' <<<"${rest%%, *}" || true)
  if [ -z "$sections" ]; then
    echo "$at: [$key$rest] has no section number"
    failed=1
  fi
  for section in $sections; do
    grep -qE "^##+ ${section//./\\.} " "${cited_pages[@]}" || {
      echo "$at: [$key$rest]: ${cited_pages[*]} has no section $section"
      failed=1
    }
  done
done <<<"$cited"

# Tests that a page names must exist.
for name in $(grep -hoP '`\K[A-Z]\w+\.[A-Z]\w+(?=`)' $pages/*.md | sort -u); do
  grep -rqE "^(TEST|TEST_F|TEST_P)\(${name%.*}, ${name#*.}\)" tests || {
    echo "$pages names the test $name, which does not exist"
    failed=1
  }
done
# Names of tests. Two wrong names are planted: one that is too long, and a suite without a case.
tests_named=$(find tests -name '*.cpp' -print0 | xargs -0 perl -0777 -ne '
  while (/^(?:TYPED_)?TEST(?:_[FP])?\(\s*(\w+)\s*,\s*(\w+)\s*\)/mg) { print "$ARGV:$1.$2\n" }')
wrong_names() { # reads file:Suite.Name
  awk -F: -v suites=" $(sed -n 's/^[0-9]*|.*|\(HardCase[A-Za-z]*\)$/\1/p' tests/acceptance/hard_cases.list | tr '\n' ' ')" '
    length($2) > 60 { print $1 ": the test " $2 " has " length($2) " characters; 60 are allowed" }
    { split($2, parts, ".") }
    parts[1] ~ /^HardCase/ && !index(suites, " " parts[1] " ") { print $1 ": the suite " parts[1] " is not in tests/acceptance/hard_cases.list" }'
}
[ "$(wc -l <<<"$tests_named")" -ge 2000 ] || { echo "FAILED: only $(wc -l <<<"$tests_named") tests were found" && failed=1; }
wrong_names <<<"$tests_named" | grep . && failed=1
planted=$(printf 'a.cpp:%s\n' "ASuite.$(printf 'x%.0s' {1..54})" HardCase99.Test ASuite.Test | wrong_names | wc -l)
[ "$planted" = 2 ] || { echo "FAILED: $planted of 2 wrong names were found" && failed=1; }
[ $failed = 0 ] && echo "$(wc -l <<<"$cited") citations, all in the references."
exit $failed
