#!/usr/bin/env bash
# Installs a compiler and an emulator for 64-bit ARM. Without them the other makers' interfaces are not tested there.
exec "$(dirname "$0")/../../app/optional_parts.sh" install arm64
