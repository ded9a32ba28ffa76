#!/usr/bin/env bash
# Fuzzes what reads scenes and arms, what reads meshes, what reads pages and what reads recordings, each kind of
# file for 60 s (THIMBLE_FUZZ_SECONDS says another time), as many at once as there are processors. In the long form
# (THIMBLE_LONG) it builds the fuzzer before; without it and without a fuzzer it is skipped.
#   tests/fuzz/run_files.sh BUILD_DIR CORPUS
set -euo pipefail
fuzzer=$(realpath "$1")/fuzz_files
corpus=$(realpath "$2")
[ -z "${THIMBLE_LONG:-}" ] || ninja -C "$1/../.." file_fuzzer
if [ ! -x "$fuzzer" ]; then
  echo "FUZZING SKIPPED: build it with: cmake --build --preset release --target file_fuzzer"
  exit 77
fi
seconds=${THIMBLE_FUZZ_SECONDS:-60}
[ -n "${TMPDIR:-}" ] || [ ! -w /dev/shm ] || export TMPDIR=/dev/shm  # some disks are slow
work=$(mktemp -d)
export TMPDIR=$work  # the files that are read
trap 'rm -rf "$work"' EXIT
# What assimp and HDF5 leak or ask for is theirs; a refused allocation is an error for them, and ours
# to tell.
export LSAN_OPTIONS=suppressions=$(realpath "$(dirname "$0")/../support/lsan_suppressions.txt"):print_suppressions=0
export ASAN_OPTIONS=allocator_may_return_null=1
cd "$work"
# A crash is shown: copy it into the corpus of its kind, named after the fault.
fuzz() {  # fuzz KIND
  mkdir "found_$1"
  THIMBLE_FILE_KIND=$1 "$fuzzer" -max_total_time="$seconds" -max_len=2000 -timeout=20 \
    -malloc_limit_mb=65536 -rss_limit_mb=4096 -seed=1 -print_final_stats=1 \
    -artifact_prefix="$work/$1_" "found_$1" "$corpus/$1" >"$1.log" 2>&1 || {
    tail -n 40 "$1.log"
    for crash in "$work/$1_"*; do
      [ -f "$crash" ] && echo "$crash:" && od -A n -t x1 "$crash"
    done
    return 1
  }
  echo "$1: $(grep -oE 'number_of_executed_units: *[0-9]+' "$1.log")"
}
export -f fuzz
export fuzzer corpus work seconds
for kind in "$corpus"/*; do basename "$kind"; done |
  xargs -P "$(nproc)" -I{} bash -c 'set -euo pipefail; fuzz {}'
