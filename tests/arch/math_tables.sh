#!/usr/bin/env bash
# The tables of driver/src/math must equal the output of their script.
#   math_tables.sh SOURCE_DIR
set -euo pipefail
folder=$1/driver/src/math
python3 "$folder/make_tables.py" | diff - "$folder/tables.h" || {
  echo "FAILED: driver/src/math/tables.h differs from the output of make_tables.py" >&2
  exit 1
}
