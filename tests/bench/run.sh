#!/usr/bin/env bash
# Measures the time of a tick on this machine, as a whole and by part, contact on meshes of many
# sizes compared with other libraries if they are installed (Debian: libembree-dev libcgal-dev
# libfcl-dev libbullet-dev), contact with meshes on disk (640 MB for two minutes), many arms in one
# process, a world of up to 10^5 objects, the time from the command to the first tick (200 MB for a
# minute), and the cost of watching a run (Debian: chromium python3-websockets libjs-three
# libjs-dygraphs).
# Prints tables and writes figures.json. Figures are reported, never pass criteria.
#   tests/bench/run.sh [FOLDER]      FOLDER: where to write (default build/bench)
set -euo pipefail
cd "$(dirname "$0")/../.."
folder=${1:-build/bench}
app/setup.sh release thimble bench_tick bench_batch bench_world bench_contact bench_paged bench_body bench_view
mkdir -p "$folder"
build/release/tests/bench/bench_tick --benchmark_repetitions=5 \
  --benchmark_enable_random_interleaving=true \
  --benchmark_report_aggregates_only=true \
  --benchmark_out="$folder/bench_tick.json" --benchmark_out_format=json \
  --figures="$folder/figures.json"
mkdir -p "$folder/batch"
build/release/tests/bench/bench_batch --figures="$folder/batch/figures.json"
mkdir -p "$folder/world"
build/release/tests/bench/bench_world --figures="$folder/world/figures.json"
mkdir -p "$folder/contact"
build/release/tests/bench/bench_contact --figures="$folder/contact/figures.json"
mkdir -p "$folder/paged"
build/release/tests/bench/bench_paged --folder="$folder/paged" \
  --figures="$folder/paged/figures.json"
mkdir -p "$folder/body"
build/release/tests/bench/bench_body --benchmark_repetitions=5 \
  --benchmark_report_aggregates_only=true --figures="$folder/body/figures.json"
build/release/tests/bench/bench_view
mkdir -p "$folder/start"
/usr/bin/python3 tests/bench/start_bench.py build/release "$folder/start/figures.json"
if app/optional_parts.sh install browser; then
  app/fetch_meshes.sh >/dev/null
  mkdir -p "$folder/watch"
  /usr/bin/python3 tests/bench/watch_bench.py build/release app/scenes/elephant.yaml \
    "$folder/watch/figures.json"
fi
