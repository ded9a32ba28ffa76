#!/usr/bin/env bash
# Prints every command of the guide and the README, one per line: page, tab, command. Those of the
# guide are its blocks marked "sh", in order. Studies take minutes and have their own tests: without
# THIMBLE_LONG they are only started.
#   guide_commands.sh SOURCE_FOLDER
set -euo pipefail
source=$1
commands_of() {  # PAGE FILE
  awk '/^```sh$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$2" | sed "s/^/$1\t/"
}
{
  for page in $(sed -n 's/^ *- .*: \(.*\.md\)$/\1/p' "$source/app/guide/mkdocs.yml"); do
    commands_of "$page" "$source/app/guide/pages/$page"
  done
  sed -nE 's|^build/release/app/(thimble [^#]*[^# ]) *(#.*)?$|README.md\t\1|p' "$source/README.md"
} | while IFS=$'\t' read -r page line; do
  if [[ $line == "thimble study "* ]] && [ -z "${THIMBLE_LONG:-}" ]; then
    # Errors appear at once; a started command is interrupted.
    line="timeout -s INT 1 $line || [ \$? = 124 ]"
  fi
  printf '%s\t%s\n' "$page" "$line"
done
