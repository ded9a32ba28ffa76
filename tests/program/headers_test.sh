#!/usr/bin/env bash
# Checks the installed headers: their number is limited, each compiles by itself with only Eigen
# installed, none names a library that a user need not know, and each has its page in the reference.
# In the short form all of them are compiled in one program, in both orders.
#   headers_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
build=$1 source=$2
most=100
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "FAILED: $*" >&2
  exit 1
}

cmake --install "$build" --component dev --prefix "$work/usr" >"$work/log" || fail "$(cat "$work/log")"
cd "$work/usr/include"
# Those in thimble/compat are other makers' APIs, which users of Thimble's API do not include: they do not count.
find thimble -path thimble/compat -prune -o -name '*.h' -print | sort >"$work/headers"
cut -d/ -f2 "$work/headers" | sort | uniq -c
# thimble/version.h, which CMake writes (driver/version.h.in), and thimble/driver/export.h, which other headers include: they
# do not count. Nor do old names of renamed headers, which only include the new ones.
count=$(grep -vxE 'thimble/(version|driver/export)\.h' "$work/headers" | xargs grep -L '^// Deprecated: former header' | wc -l)
[ "$count" -lt "$most" ] || fail "$count headers are installed; there may be fewer than $most"

if grep -nE '#include *[<"](yaml-cpp|YAML|hdf5|H5|fmt|spdlog|nlohmann|CLI|libusb|hidapi|assimp|png)' -r thimble; then
  fail "the lines above include a library that a user need not know"
fi
if grep -nE '#include *"' -r thimble --exclude-dir=compat | grep -v '"thimble/'; then
  fail "the lines above include what is not installed"
fi

# Each by itself, in a program without any other include. Eigen's headers, which most of them begin with, are parsed
# once: a header gets the one that it includes itself.
check() {  # ARGUMENTS...
  "${CXX:-c++}" -std=c++20 -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Werror -I. -isystem "$eigen" "$@"
}
compile() {  # HEADER
  local own=Geometry parsed=()
  grep -qE '#include *<Eigen/Geometry>' "$1" || own=Core
  ! grep -qE "#include *<Eigen/$own>" "$1" || parsed=(-Winvalid-pch -include "$work/eigen/$own.h")
  echo "#include \"$1\"" | check -fsyntax-only "${parsed[@]}" -x c++ - || echo "$1" >>"$work/bad"
}
export -f check compile
export work eigen
eigen=$(pkg-config --variable=prefix eigen3)/include/eigen3
alone="compile alone"
if [ -n "${THIMBLE_LONG:-}" ]; then
  mkdir "$work/eigen"
  for own in Core Geometry; do
    echo "#include <Eigen/$own>" >"$work/eigen/$own.h"
    check -x c++-header "$work/eigen/$own.h" -o "$work/eigen/$own.h.gch"
  done
  xargs -a "$work/headers" -P "$(nproc)" -I{} bash -c 'compile {}'
else
  alone="compile together"
  for order in sort "sort -r"; do
    sed 's/.*/#include "&"/' "$work/headers" | $order | check -fsyntax-only -x c++ - || echo "all in the order of $order" >>"$work/bad"
  done
fi
[ ! -s "$work/bad" ] || fail "do not $alone: $(sort "$work/bad" | tr '\n' ' ')"

# thimble/thimble.h includes every header that is not an old name, of the components that a program links.
definitions=()
for component in device_sim render scene session; do
  definitions+=("-DTHIMBLE_HAS_${component^^}")
done
echo '#include "thimble/thimble.h"' | check -fsyntax-only "${definitions[@]}" -x c++ - || fail "thimble/thimble.h does not compile with all components"
included() {  # DEFINITIONS...
  echo '#include "thimble/thimble.h"' | "${CXX:-c++}" -std=c++20 -I. -isystem "$eigen" "$@" -M -x c++ - |
    tr ' ' '\n' | grep -oE '(^|/)thimble/.*\.h$' | sed 's|^/||' | sort -u
}
xargs -a "$work/headers" grep -L '^// Deprecated: former header' | sort >"$work/current"
included "${definitions[@]}" | sort | comm -13 - "$work/current" >"$work/missing"
[ ! -s "$work/missing" ] || fail "thimble/thimble.h does not include $(tr '\n' ' ' <"$work/missing")"
if included | grep -E '^thimble/(device_sim|render|scene|session)/'; then
  fail "thimble/thimble.h includes the lines above in a program that links only the driver"
fi

# The reference is made from the same folders.
while read -r header; do
  [ "$header" != thimble/version.h ] || continue
  module=$(cut -d/ -f2 <<<"$header")
  folder=$module/include
  [ -d "$source/$folder" ] || folder=app/$module/include
  [ "$header" != thimble/thimble.h ] || folder=app/install/include
  grep -qF "@PROJECT_SOURCE_DIR@/$folder" "$source/app/guide/Doxyfile.in" ||
    fail "$header is installed, but the reference does not read $folder"
  [ -f "$source/$folder/$header" ] || fail "$header is installed, but does not come from $folder"
done <"$work/headers"

# Other makers' APIs: each header by itself, in C as well; two have only classes.
others=0
while read -r header; do
  others=$((others + 1))
  for language in c++ c; do
    [ "$language" = c ] && [[ $header =~ hdu(Matrix|Quaternion) ]] && continue
    echo "#include <$header>" | "${CC:-cc}" -fsyntax-only -Wall -Wextra -Werror -Ithimble/compat -x "$language" - ||
      fail "$header does not compile alone in $language"
  done
done < <(cd thimble/compat && find . -name '*.h' -printf '%P\n' | sort)
[ "$others" -gt 0 ] || fail "no header of other makers' interfaces is installed"
echo "$count headers, which $alone; $others of other makers' interfaces do, too."
