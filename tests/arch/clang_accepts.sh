#!/usr/bin/env bash
# Fails if clang rejects or warns about a source of driver, device_sim or render that GCC built. It reads the sources and
# builds nothing. `tests/run.sh --long` builds the whole project with clang.
#   clang_accepts.sh BUILD_DIR
# Exits with 77 if clang is missing.
set -euo pipefail
command -v clang++ >/dev/null || {
  echo "SKIPPED: clang is not installed (tests/fuzz/setup.sh)" >&2
  exit 77
}
cd "$1"
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT

# Each source and its options, without options of GCC and without output files.
/usr/bin/python3 - >"$folder/sources" <<'EOF'
import json, shlex

for entry in json.load(open('compile_commands.json')):
    words = shlex.split(entry['command'])
    name = words[words.index('-o') + 1]
    if not name.startswith(('driver/', 'device_sim/', 'render/')): continue
    kept = [word for word in words[1:-1]
            if word.startswith(('-D', '-I', '-W', '-f', '-std=')) and word != '-Winvalid-pch']
    for word, folder in zip(words, words[1:]):
        if word == '-isystem': kept += [word, folder]
    print(entry['file'], shlex.join(kept), sep='\t')
EOF
[ -s "$folder/sources" ] || { echo "No source of the libraries in $1/compile_commands.json" >&2 && exit 1; }

# Common headers, precompiled once for each set of options.
bad=0
while IFS=$'\t' read -r source options; do
  headers=$folder/$(md5sum <<<"$options" | cut -c1-32)
  if [ ! -e "$headers" ]; then
    cp CMakeFiles/thimble_ticking_headers.dir/cmake_pch.hxx "$headers.h"
    eval "clang++ $options -w -x c++-header '$headers.h' -o '$headers'"
  fi
  eval "clang++ $options -Wno-psabi -Wno-unknown-warning-option -include-pch '$headers' -fsyntax-only '$source'" >"$folder/said" 2>&1 || {
    echo "clang does not accept $source:"
    grep -E "error" -A 3 "$folder/said" | head -n 20
    bad=1
  }
done <"$folder/sources"
exit $bad
