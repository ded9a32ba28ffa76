#!/usr/bin/env bash
# Installs what fuzzing needs (40 MB): clang++, which reports coverage to libFuzzer, and libFuzzer. The replays of the
# corpora run without them.
exec "$(dirname "$0")/../../app/optional_parts.sh" install fuzzing
