#!/usr/bin/env bash
# Fuzzes the decoders for 5 s, or 60 s with THIMBLE_LONG. Skipped where the fuzzer was not built.
#   tests/fuzz/run.sh BUILD_DIR CORPUS
set -euo pipefail
fuzzer=$(realpath "$1")/fuzz_decoders
corpus=$(realpath "$2")
if [ ! -x "$fuzzer" ]; then
  echo "FUZZING SKIPPED: build it with: cmake --build --preset release --target fuzz"
  exit 77
fi
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# New files go to the working folder, a crash too: copy it into the corpus, named after the fault.
cd "$work"
mkdir found
"$fuzzer" -max_total_time="$([ -n "${THIMBLE_LONG:-}" ] && echo 60 || echo 5)" -max_len=200 -seed=1 \
  -print_final_stats=1 found "$corpus" 2>&1 | tail -n 12
exit "${PIPESTATUS[0]}"
