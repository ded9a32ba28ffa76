#!/usr/bin/env bash
# Fuzzes the readers of arm messages, of USB/IP, of the memory shared with viewers and of described wires, with 60,000
# inputs each, which depend on the seed only. THIMBLE_FUZZ_SECONDS sets a time instead; with THIMBLE_LONG every single
# decoder runs for 60 s, one per processor at a time. Skipped if the fuzzer was not built.
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
# New files go to the working folder, and so do crashes: copy these into the corpus, named after the fault.
cd "$work"
fuzz() {  # fuzz NAME DECODERS LIMIT; LIMIT: an option of libFuzzer
  mkdir "found_$1"
  THIMBLE_DECODERS=$2 "$fuzzer" "$3" -max_len=200 -seed=1 -print_final_stats=1 \
    -artifact_prefix="$work/$1_" "found_$1" "$corpus" >"$1.log" 2>&1 || {
    tail -n 40 "$1.log"
    for crash in "$work/$1_"*; do
      [ -f "$crash" ] && echo "$crash:" && od -A n -t x1 "$crash"
    done
    return 1
  }
  echo "$1: $(grep -oE 'number_of_executed_units: *[0-9]+' "$1.log")"
}
# Numbers as in decode_anything.
arms=0-8 usbip=9-10 memory=11-11 wires=12-15
if [ -z "${THIMBLE_LONG:-}" ]; then
  limit=-runs=60000
  [ -z "${THIMBLE_FUZZ_SECONDS:-}" ] || limit=-max_total_time=$THIMBLE_FUZZ_SECONDS
  for name in arms usbip memory wires; do fuzz "$name" "${!name}" "$limit"; done
  exit
fi
export -f fuzz
export fuzzer corpus work
seq 0 "${wires#*-}" |
  xargs -P "$(nproc)" -I{} bash -c 'set -euo pipefail; fuzz decoder_{} {}-{} -max_total_time=60'
