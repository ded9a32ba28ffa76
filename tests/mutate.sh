#!/usr/bin/env bash
# Breaks single places of driver and render and looks whether a test fails: what survives is a fault that no
# test would see. Writes tests/MUTANTS.md; at least 90 % must be killed.
#   tests/mutate.sh [--count N] [--seed S] [--library driver|render] [--survivors] [--again FILE:LINE]...
#     --count N     a sample of N mutants, half of them of each library; 400 without it
#     --survivors   after new tests: only what survived the run before, or was not reached by it when it was
#                   interrupted; of the others its result is taken
#     --again       only mutants of that line, and nothing is written
# All mutants are built at once, in a copy of the sources in build/mutants; the environment chooses one of them
# when a test runs. A first run notes which tests come by which mutant. Ends with 1 below 90 %, with 3 where
# python3 or git is missing.
set -euo pipefail
cd "$(dirname "$0")/.."
command -v python3 >/dev/null && git rev-parse --git-dir >/dev/null 2>&1 || {
  echo "tests/mutate.sh needs python3, git (apt-get install python3 git) and a clone of the project" >&2
  exit 3
}
exec python3 -B tests/mutate/mutate.py --root "$PWD" --plan tests/mutate/plan.json --work "$PWD/build/mutants" \
  --table tests/MUTANTS.md "$@"
