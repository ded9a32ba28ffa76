#!/usr/bin/env bash
# Writes the guide's page of all keys of scene and arm files, from the program's own readers.
#   app/guide/keys.sh [PROGRAM]      prints the page; put it into app/guide/pages/keys.md
set -euo pipefail
program=${1:-build/release/app/thimble}
cat "$(dirname "$0")/keys_head.md"
printf '\n## Scenes\n'
"$program" help scene --page
printf '\n## Arms\n'
"$program" help arm --page
