#!/usr/bin/env bash
# Each source and header is formatted with clang-format (.clang-format). Debian 12's version 14 decides;
# without it the test is skipped.
#   format.sh SOURCE_FOLDER
set -euo pipefail
cd "$1"
command -v clang-format-14 >/dev/null || {
  echo "SKIPPED: clang-format-14 is not installed"
  exit 77
}
find app device_sim driver render tests -type f \( -name '*.h' -o -name '*.cpp' \) -print0 |
  xargs -0 -P "$(nproc)" -n 100 clang-format-14 --dry-run --Werror
