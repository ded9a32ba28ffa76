#!/usr/bin/env bash
# Runs clang-tidy on every source of the tree (checks: .clang-tidy). It reads sources joined, as they
# are built, so that common includes are parsed once per group; no build is needed before.
# Forty minutes of one processor. (Debian: clang-tidy.)
#   tests/tidy.sh [REGEX]      REGEX: only compiled files with such a name, e.g. render/
set -euo pipefail
cd "$(dirname "$0")/.."
command -v clang-tidy >/dev/null || {
  echo "tests/tidy.sh needs clang-tidy: apt-get install clang-tidy" >&2
  exit 3
}
build=build/tidy
mkdir -p build
cmake --preset release -B "$build" -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON >"build/tidy.log" || {
  tail -n 20 build/tidy.log >&2
  exit 4
}
found=$(mktemp -d)
trap 'rm -rf "$found"' EXIT
ask() {  # ask FILE: prints its findings, once per place
  local said status=0 config=.clang-tidy
  [[ $1 != */tests/* ]] || config=tests/.clang-tidy
  said=$(clang-tidy -p "$build" --config-file="$config" --quiet --extra-arg=-Wno-unknown-warning-option \
    --extra-arg=-Wno-unused-command-line-argument \
    --checks=-bugprone-suspicious-include "$1" 2>/dev/null) || status=$?
  if ! grep -qE '(warning|error):' <<<"$said"; then
    [ $status != 0 ] || return 0
    said="$1: error: clang-tidy ended with $status and said nothing"
  fi
  printf '%s\n' "$said" | tee -a "$found/findings"
}
export -f ask
export build found
sed -n 's/^ *"file": "\(.*\)",*$/\1/p' "$build/compile_commands.json" | sort -u |
  { grep -E "${1:-.}" || true; } >"$found/files"
[ -s "$found/files" ] || {
  echo "tests/tidy.sh: no compiled file has a name like '${1:-}'." >&2
  exit 2
}
echo "clang-tidy reads $(wc -l <"$found/files") files, most of them many sources joined ..."
xargs -P "${THIMBLE_TIDY_JOBS:-$(nproc)}" -I{} bash -c 'ask {}' <"$found/files"
if [ -s "$found/findings" ]; then
  echo "clang-tidy finds $(grep -cE '(warning|error):' "$found/findings") faults." >&2
  exit 1
fi
echo "clang-tidy finds nothing."
