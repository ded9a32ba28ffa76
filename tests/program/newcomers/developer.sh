#!/usr/bin/env bash
# A C++ developer: a program with a session and a force law, built with pkg-config or CMake.
source "$(dirname "$0")/follow.sh"

has c++ || {
  echo "  NOT TESTED: a program in C++; no compiler is here."
  exit 0
}
says guide/cpp.md 'The program loads a scene by name, halves its force, records the run and replays it'
awk '/^```cpp$/ { inside = 1; next } /^```/ { if (inside) exit } inside' "$DOCUMENTS/guide/cpp.md" >touch.cpp
grep -q 'set_law' touch.cpp || fail "the guide's program has no law"
sed -i 's/"elephant"/"rubber"/' touch.cpp  # needs no scan
says guide/cpp.md '`find_package(thimble)` gives the targets'
says guide/cpp.md '`pkg-config thimble` works as well'
if [ -n "${THIMBLE_LONG:-}" ]; then
  says guide/cpp.md 'target_link_libraries(touch PRIVATE thimble::session)'
  {
    printf 'cmake_minimum_required(VERSION 3.25)\nproject(touch CXX)\nadd_executable(touch touch.cpp)\n'
    awk '/^```cmake$/ { inside = 1; next } /^```/ { if (inside) exit } inside' "$DOCUMENTS/guide/cpp.md"
  } >CMakeLists.txt
  { cmake -S . -B build && cmake --build build; } >said 2>&1 || fail "CMake: $(cat said)"
  mv build/touch by_cmake
  see '^Force +[0-9.]+ N maximum' ./by_cmake
fi
c++ $(pkg-config --cflags thimble) -O0 touch.cpp -o by_pkg_config $(pkg-config --libs thimble) 2>said ||
  fail "pkg-config: $(cat said)"
# Names are found automatically only below /usr.
says guide/cpp.md 'For another prefix, run `export XDG_DATA_DIRS=~/thimble/share:/usr/share`'
share=$(pkg-config --variable=prefix thimble)/share
export XDG_DATA_DIRS=$share:/usr/share
see '^Force +[0-9.]+ N maximum' ./by_pkg_config
see '6000 ticks of rubber' thimble export touch.h5 --csv touch.csv

# A scene in code: the guide's lines in a program.
says guide/scenes_in_code.md 'This page explains how a C++ program makes a scene without a YAML file.'
{
  echo '#include <cstdio>'
  echo 'static int complain(const thimble::driver::Error& error);'
  awk '/^```cpp$/ { inside = 1; next } /^```/ { if (inside) exit } inside' "$DOCUMENTS/guide/scenes_in_code.md" >lines
  grep '^#include' lines
  echo 'int main() {'
  grep -v '^#include' lines
  echo '  std::printf("%s\n", summary((*run)->figures()).c_str());'
  echo '}'
  echo 'int complain(const thimble::driver::Error& error) { std::puts(error.message.c_str()); return 2; }'
} >desk.cpp
# The header comes before the first use of its names.
{ grep '^#include' desk.cpp; grep -v '^#include' desk.cpp; } >in_code.cpp
c++ $(pkg-config --cflags thimble) -O0 in_code.cpp -o in_code $(pkg-config --libs thimble) 2>said ||
  fail "a scene in code: $(cat said)"
see '^Force +[0-9.]+ N maximum' ./in_code
