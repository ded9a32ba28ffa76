#!/usr/bin/env bash
# Fails if code calls a function of 16-byte vectors that sse2_test.cpp does not compare between processors.
# Vectors of 32 bytes are allowed in code that is for x86-64 only.
#   other_processors.sh SOURCE_DIR
set -euo pipefail
cd "$1"
compared=tests/unit/render/search/sse2_test.cpp
bad=0
while read -r name; do
  grep -qE "\b$name\(" $compared && continue
  echo "$name is called, but $compared does not compare it:"
  grep -rnE "\b$name\b" driver device_sim render app | sed 's/^/  /'
  bad=1
done < <(grep -rhoE '\b_mm_[a-z0-9_]+' driver device_sim render app | sort -u)
exit $bad
