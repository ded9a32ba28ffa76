#!/usr/bin/env bash
# The libraries of the compatibility layer export exactly the names of their tables and need only system
# libraries. The constants of the headers are those of the table of sources, and the types have the sizes of the makers'
# headers, on this processor and on 64-bit ARM if its compiler is installed.
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
# The guide's page of all functions and constants.
python3 "$source/app/guide/compat_audit.py" | diff "$source/app/guide/pages/compat_audit.md" - || {
  echo "FAILED: app/guide/pages/compat_audit.md is old; app/guide/compat_audit.py writes it"
  bad=1
}

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
{
  echo '#include <stddef.h>'
  echo '#include <HD/hd.h>'
  echo '#include <HL/hl.h>'
  echo '#include <drdc.h>'
  sed -nE 's/^\| `((HD|HL|LED)_[A-Z0-9_]+)` \| `([^`]+)` \|.*/_Static_assert((unsigned long)(\1) == (unsigned long)(\3), "\1");/p' \
    "$source/app/compat/PROVENANCE.md"
  cat <<'END'
#define SIZE(type, size) _Static_assert(sizeof(type) == (size), #type)
#define PLACE(member, place) _Static_assert(offsetof(HDErrorInfo, member) == (place), #member)
SIZE(HDErrorInfo, 12); PLACE(errorCode, 0); PLACE(internalErrorCode, 4); PLACE(hHD, 8);
SIZE(HDint, 4); SIZE(HDuint, 4); SIZE(HDboolean, 1); SIZE(HDushort, 2); SIZE(HDulong, 8); SIZE(HDlong, 8); SIZE(HDfloat, 4);
SIZE(HDdouble, 8); SIZE(HDchar, 1); SIZE(HDenum, 4); SIZE(HDerror, 4); SIZE(HHD, 4); SIZE(HDstring, 8);
SIZE(HDSchedulerHandle, 8); SIZE(HDCallbackCode, 4); SIZE(HDSchedulerCallback, 8); SIZE(HDWaitCode, 4);
SIZE(HLerror, 24); SIZE(HLenum, 8); SIZE(HLboolean, 1); SIZE(HLint, 4); SIZE(HLuint, 4); SIZE(HHLRC, 8); SIZE(HLbitfield, 4);
SIZE(uchar, 1); SIZE(ushort, 2); SIZE(uint, 4); SIZE(bool, 1);
END
} >"$work/table.c"
[ "$(grep -c '^_Static_assert' "$work/table.c")" -gt 100 ] || { echo "FAILED: the table of sources was not read"; bad=1; }
for compiler in "${CC:-cc}" aarch64-linux-gnu-gcc; do
  command -v "$compiler" >/dev/null || continue
  "$compiler" -std=c11 -D_DEFAULT_SOURCE -fsyntax-only -I"$source/app/compat/include/thimble/compat" "$work/table.c" || {
    echo "FAILED: a constant or type of our headers differs ($compiler)"
    bad=1
  }
done
exit $bad
