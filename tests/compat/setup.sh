#!/usr/bin/env bash
# Installs a compiler and an emulator for 64-bit ARM. Without them the compatibility layer is not tested there.
exec "$(dirname "$0")/../../app/optional_parts.sh" install arm64
