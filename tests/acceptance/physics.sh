#!/usr/bin/env bash
# Runs the tests that compare physical values with closed forms and writes them to tests/acceptance/PHYSICS.md.
#   tests/acceptance/physics.sh [BUILD]        BUILD: a built folder (build/release if none is named)
#   tests/acceptance/physics.sh --check LINES  LINES: the folder of lines of a finished run; writes nothing.
# Fails if an error is above its bound or (--check) the page in the repository differs. Rows must be
# equal except for measured values and errors. Errors may differ by 20 %, or by a hundredth of their
# bound, because another compiler rounds differently.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
page=${THIMBLE_PHYSICS_PAGE:-$here/PHYSICS.md}
export LC_ALL=C
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Writes the page of a folder of lines to a file; prints the errors and fails if there are any.
make_page() {
  : >"$scratch/faults"
  [ ! -d "$1" ] || find "$1" -type f | sort | xargs -r cat >"$scratch/lines"
  touch "$scratch/lines"
  awk -v faults="$scratch/faults" -f "$here/physics.awk" "$scratch/lines" >"$2"
  [ -s "$scratch/faults" ] || return 0
  echo "Errors of the physical values:" >&2
  sed 's/^/  /' "$scratch/faults" >&2
  return 1
}

if [ "${1:-}" = --check ]; then
  [ $# = 2 ] || { echo "Usage: tests/acceptance/physics.sh --check LINES" >&2; exit 2; }
  make_page "$2" "$scratch/now.md"
  sed -n 's/^\([0-9]* values of .*\)$/\1/p' "$scratch/now.md"
  [ -z "${THIMBLE_LONG:-}" ] || exit 0
  awk -v name="$page" '
    function value(cell) { sub(/^< /, "", cell); return cell + 0 }
    function near(a, b, bound,   apart) {
      apart = a > b ? a - b : b - a
      return apart <= 0.2 * (a > b ? a : b) || apart <= 0.01 * bound
    }
    BEGIN { FS = " [|] " }
    NR == FNR { stored[NR] = $0; stored_count = NR; next }
    {
      if ($0 == stored[FNR]) next
      n = split(stored[FNR], old, " [|] ")
      equal = n == 8 && NF == 8 && $1 == old[1] && $2 == old[2] && $3 == old[3] && $5 == old[5] && $7 == old[7] && $8 == old[8]
      if (equal && near(value($6), value(old[6]), value($7))) next
      print "  " name ":" FNR " has\n    " stored[FNR] "\n  and the tests measure\n    " $0
      bad = 1
    }
    END { exit bad || FNR != stored_count }' "$page" "$scratch/now.md" >&2 || {
    echo "The page differs from the measurements. Run tests/acceptance/physics.sh and review the changes." >&2
    exit 1
  }
  exit 0
fi

build=$(cd "${1:-$here/../../build/release}" && pwd)
ctest --test-dir "$build" -R '^(Physics|physics\.begin)' -j "$(nproc)" >"$scratch/log" || {
  grep -A30 "tests failed" "$scratch/log" >&2
  exit 1
}
status=0
make_page "$build/physics_lines" "$page" || status=1
echo "$page: $(grep -m1 ' values of ' "$page")"
exit $status
