#!/usr/bin/env bash
# Runs the tests of the hard cases and writes their measurements to tests/acceptance/HARD_CASES.md.
#   tests/acceptance/hard_cases.sh [BUILD]        BUILD: a built folder (build/release if none is named)
#   tests/acceptance/hard_cases.sh --check LINES  LINES: the folder of lines of a finished run; writes nothing.
# Fails if a case has no figure, a figure misses its criterion, or (--check) the table in the
# repository differs. Rows must be equal except for their figures, which may differ by 2 %, or
# by a factor of 2 if both are 10 times better than required, or by any factor if both are 1000
# times better, because another compiler or libm rounds differently. The long form
# (THIMBLE_LONG) measures more, so its figures are not compared.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
table=$here/HARD_CASES.md
export LC_ALL=C
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

# Writes the table of a folder of lines to a file; prints the errors and fails if there are any.
make_table() {
  : >"$scratch/faults"
  [ ! -d "$1" ] || find "$1" -type f | sort | xargs -r cat >"$scratch/lines"
  touch "$scratch/lines"
  awk -v faults="$scratch/faults" -f "$here/hard_cases.awk" "$here/hard_cases.list" \
    "$scratch/lines" >"$2"
  [ -s "$scratch/faults" ] || return 0
  echo "Errors of the hard cases:" >&2
  sed 's/^/  /' "$scratch/faults" >&2
  return 1
}

if [ "${1:-}" = --check ]; then
  [ $# = 2 ] || { echo "Usage: tests/acceptance/hard_cases.sh --check LINES" >&2; exit 2; }
  make_table "$2" "$scratch/now.md"
  sed -n 's/^\([0-9]* of .*guards\.\)$/\1/p' "$scratch/now.md"
  [ -z "${THIMBLE_LONG:-}" ] || exit 0
  awk -v name="$table" '
    function value(cell) {
      gsub(/−/, "-", cell)
      return cell ~ /∞/ ? 1e300 : cell + 0
    }
    function same(a, b, share,   most) {
      most = a < 0 ? -a : a
      if (b > most) most = b
      if (-b > most) most = -b
      return (a - b <= share * most) && (b - a <= share * most)
    }
    # Distance of a row from its limit, by its margin.
    function times(cell) { return cell ~ /> 1000|all/ ? 1000 : cell ~ /×/ ? cell + 0 : 0 }
    BEGIN { FS = " [|] " }
    NR == FNR { stored[NR] = $0; stored_count = NR; next }
    {
      if ($0 == stored[FNR]) next
      n = split(stored[FNR], old, " [|] ")
      equal = n == 6 && NF == 6 && $2 == old[2] && $4 == old[4] && $6 == old[6]
      least = times($5) < times(old[5]) ? times($5) : times(old[5])
      near = least >= 1000 || same(value($3), value(old[3]), least >= 10 ? 0.5 : 0.02)
      if (equal && near) next
      print "  " name ":" FNR " has\n    " stored[FNR] "\n  and the tests measure\n    " $0
      bad = 1
    }
    END { exit bad || FNR != stored_count }' "$table" "$scratch/now.md" >&2 || {
    echo "The table differs from the measurements. Run tests/acceptance/hard_cases.sh and review the changes." >&2
    exit 1
  }
  exit 0
fi

build=$(cd "${1:-$here/../../build/release}" && pwd)
ctest --test-dir "$build" -R '^(HardCase|hard_cases\.begin)' -j "$(nproc)" >"$scratch/log" || {
  grep -A30 "tests failed" "$scratch/log" >&2
  exit 1
}
status=0
make_table "$build/hard_case_lines" "$table" || status=1
echo "$table: $(grep -m1 ' guards\.$' "$table")"
exit $status
