#!/usr/bin/env bash
# Checks the symbols of the installed archives: every strong symbol is in namespace thimble and declared by a
# header, so that no function of a user's program can have the same name, and everything else has internal
# linkage. Then a library with violations must be detected.
#   symbols_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
build=$1 source=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "FAILED: $*" >&2
  exit 1
}
cd "$work"
# C functions for users, one per line: none.
: >c_functions
cmake --install "$build" --component dev --prefix "$work/usr" >log || fail "$(cat log)"
(cd "$source" && find driver device_sim render app -name '*.h' -print0 | xargs -0 cat) | grep -oE '[A-Za-z_][A-Za-z_0-9]*' | sort -u >declared

# strong ARCHIVE: prints each strong external symbol that it defines.
strong() { nm -gP --defined-only "$1" | awk '$2 ~ /^[TDBRSG]$/ { print $1 }' | sort -u; }

# In namespace thimble: a function or an object, a table of a class, a function that corrects its `this`.
ours='^_Z(TV|TI|TS|TT|TC|GV|Th?n?[0-9]+_|Tvn?[0-9]+_n?[0-9]+_)?Z?N[VKRO]*7thimble'

# look_at ARCHIVE: prints a line for each forbidden symbol.
look_at() {
  strong "$1" >symbols
  grep -vE "$ours" symbols | grep -vxF -f c_functions |
    sed "s/$/ is not in namespace thimble/" || true
  # The last two parts of a name without arguments, such as "SafetyGate pass". A class of a header may have
  # members that only its source uses.
  { grep -E "$ours" symbols || true; } | c++filt >demangled
  sed -E 's/^(vtable|typeinfo|typeinfo name|VTT|guard variable|(non-)?virtual thunk) (for|to) //; s/\[abi:[a-z0-9]+\]//g; s/\(anonymous namespace\)/hidden/g
          :again; s/<[^<>]*>//g; t again
          s/\(.*//; s/^.* (thimble::)/\1/; s/^(.*::)?([^:]+)::~?/\2\t/' demangled |
    paste - demangled | awk -F'\t' '
      NR == FNR { known[$1] = 1; next }
      !($2 in known) && $2 !~ /^operator/ && !($1 ~ /^[A-Z]/ && $1 in known) { print $3 " is declared by no header" }' declared -
}

archives=0 count=0
: >found
while read -r archive; do
  archives=$((archives + 1))
  count=$((count + $(strong "$archive" | wc -l)))
  look_at "$archive" | sed "s/^/$(basename "$archive"): /" >>found
done < <(find "$work/usr" -name '*.a')
[ "$archives" = 5 ] || fail "$archives archives are installed, not those of driver, device_sim, render, scene and session"
[ "$count" -gt 1000 ] || fail "only $count symbols were looked at"
[ ! -s found ] || fail "$(cat found)"

# A program may use any name, such as former names of Thimble's signal handlers.
cat >leaks.cpp <<'END'
extern "C" void on_signal(int) {}
void helper(int) {}
int counter = 1;
namespace thimble::scene {
double declared_by_no_header_at_all(double x) { return 2 * x; }
namespace { int hidden_here() { return counter; } }
int load_arm() { return hidden_here(); }
}
END
"${CXX:-c++}" -std=c++20 -c leaks.cpp -o leaks.o
ar rc libleaks.a leaks.o
look_at libleaks.a >leaked
for name in on_signal _Z6helperi counter; do
  grep -q "^$name is not in namespace thimble" leaked || fail "$name was not found: $(cat leaked)"
done
grep -q 'declared_by_no_header_at_all(double) is declared by no header' leaked || fail "a hidden function was not found: $(cat leaked)"
[ "$(wc -l <leaked)" = 4 ] || fail "more was found than there is: $(cat leaked)"
echo "$count strong symbols of $archives archives: all in namespace thimble, all declared."
