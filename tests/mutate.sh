#!/usr/bin/env bash
# Changes single places of driver, render, scene and session and checks whether a test fails. A surviving mutant is a fault
# that no test would detect. Writes tests/MUTANTS.md; at least 90 % must be killed.
#   tests/mutate.sh [--count N] [--seed S] [--library driver|render|scene|session] [--budget S]
#                   [--survivors] [--again FILE:LINE]...
#     --count N     a sample of N mutants, as many of each library; 800 without it
#     --budget S    seconds of tests to try on a mutant, 60 without it; what they do not detect counts as a survivor
#     --survivors   after new tests: only the mutants that survived the last run, or were not reached when it was
#                   interrupted; the results of the others are reused
#     --again       only mutants of that line; nothing is written
# All mutants are built at once, in a copy of the sources in build/mutants; the environment selects one of them
# when a test runs. A first run notes which tests execute which mutant. Exits with 1 below 90 %, with 3 if
# python3 or git is missing.
set -euo pipefail
cd "$(dirname "$0")/.."
command -v python3 >/dev/null && git rev-parse --git-dir >/dev/null 2>&1 || {
  echo "tests/mutate.sh needs python3, git (apt-get install python3 git) and a clone of the project" >&2
  exit 3
}
exec python3 -B tests/mutate/mutate.py --root "$PWD" --plan tests/mutate/plan.json --work "$PWD/build/mutants" \
  --table tests/MUTANTS.md "$@"
