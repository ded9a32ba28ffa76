#!/usr/bin/env bash
# The libraries of the compatibility layer export exactly the names of their tables and need only system
# libraries, and a struct of 12 bytes is returned by value as callers of either ABI read it.
#   abi_test.sh LIBRARY_DIR SOURCE_DIR FOLDER=LIBRARY...
set -euo pipefail
libraries=$1 source=$2
shift 2
bad=0
for pair; do
  api=${pair%%=*} library=$libraries/lib${pair#*=}.so
  table=$source/app/compat/$api/symbols.txt
  if ! diff <(grep -E '^[A-Za-z]' "$table" | LC_ALL=C sort) \
      <(nm -D --defined-only "$library" | awk '{sub(/@.*/, "", $3); print $3}' | LC_ALL=C sort -u); then
    echo "FAILED: $library does not export what $table says (< table, > library)"
    bad=1
  fi
  needed=$(readelf -d "$library" | sed -nE 's/.*NEEDED.*\[(.*)\]/\1/p' |
    grep -vE '^(libc|libm|libpthread|ld-linux.*)\.so|^linux-vdso' || true)
  if [ -n "$needed" ]; then
    echo "FAILED: $library needs $needed, of which a program may have another version"
    bad=1
  fi
done
exit $bad
