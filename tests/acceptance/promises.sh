#!/usr/bin/env bash
# Writes the guide's pages of guarantees (guarantees.md, guarantees_contact.md) from app/guide/guarantees.list, with the
# coverage that the tests of each row reported. Needs a complete release build.
#   promises.sh [BUILD]
set -euo pipefail
cd "$(dirname "$0")/../.."
exec python3 tests/arch/promises.py . "${1:-build/release}" --write
