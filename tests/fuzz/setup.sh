#!/usr/bin/env bash
# Installs clang++, which reports coverage to libFuzzer, and libFuzzer (40 MB) for fuzzing. The replays of the
# corpora run without them.
exec "$(dirname "$0")/../../app/optional_parts.sh" install fuzzing
