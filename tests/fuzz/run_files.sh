#!/usr/bin/env bash
# Fuzzes the readers of scenes and arms, of meshes, of page files and of recordings, each for 60 s
# (THIMBLE_FUZZ_SECONDS sets another time), one per processor at a time. The long form (THIMBLE_LONG)
# builds the fuzzer first; otherwise the test is skipped without a fuzzer.
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
export TMPDIR=$work  # for the files under test
trap 'rm -rf "$work"' EXIT
# Leaks and large allocations inside assimp and HDF5 are theirs. A refused allocation is an error in them, which
# Thimble must report.
export LSAN_OPTIONS=suppressions=$(realpath "$(dirname "$0")/../support/lsan_suppressions.txt"):print_suppressions=0
export ASAN_OPTIONS=allocator_may_return_null=1
cd "$work"
# A crash is printed: copy it into the corpus of its kind, named after the fault.
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
