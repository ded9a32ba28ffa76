#!/usr/bin/env bash
# Installs what fuzzing takes (40 MB), if it can; the replays of the corpora run all the same.
set -euo pipefail
packages=(
  clang           # the compiler that tells libFuzzer which way a program went
  libclang-rt-dev # libFuzzer and the sanitizers
)
exec "$(dirname "$0")/../optional_packages.sh" "fuzzing" "${packages[@]}"
