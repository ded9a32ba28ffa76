#!/usr/bin/env bash
# Fails if code calls a function of 16-byte lanes that sse2_elsewhere.h does not have, because it would build on x86-64 only.
# Lanes of 32 bytes are allowed in code that is for x86-64 only.
#   other_processors.sh SOURCE_DIR
set -euo pipefail
cd "$1"
elsewhere=render/src/compact_mesh/sse2_elsewhere.h
bad=0
while read -r name; do
  grep -qE "[ (]$name\)?\(" $elsewhere && continue
  echo "$name is not in $elsewhere, but called:"
  grep -rnE "\b$name\b" driver device_sim render app | sed 's/^/  /'
  bad=1
done < <(grep -rhoE '\b_mm_[a-z0-9_]+' driver device_sim render app | sort -u)
exit $bad
