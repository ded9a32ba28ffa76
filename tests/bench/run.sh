#!/usr/bin/env bash
# Measures how long a tick takes on this machine, whole and part by part; prints a table and writes
# figures.json. Figures are reported, never pass criteria.
#   tests/bench/run.sh [FOLDER]      FOLDER: where to write (default build/bench)
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=${1:-build/bench}
app/setup.sh release bench_tick
mkdir -p "$folder"
build/release/tests/bench/bench_tick --benchmark_repetitions=5 \
  --benchmark_report_aggregates_only=true --benchmark_min_warmup_time=0.1 \
  --benchmark_out="$folder/bench_tick.json" --benchmark_out_format=json \
  --figures="$folder/figures.json"
