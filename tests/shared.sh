#!/usr/bin/env bash
# Tests the shared libraries (BUILD_SHARED_LIBS=ON) against the static build of the same sources.
#   tests/shared.sh [STATIC_BUILD [SHARED_BUILD]]
# Build folders of the preset core, the second with recordings; without them the script builds its own. Checks SONAME, run path
# and exported symbols, installs the libraries, moves the installation, builds the examples and a program on each library, and
# compares runs with those of the static build, by the summary of `thimble run` and by the bits of all ticks.
set -euo pipefail
static=${1:+$(realpath "$1")}
shared=${2:+$(realpath "$2")}
cd "$(dirname "$0")/.."
source=$PWD
source tests/build_check.sh
empty_folder "$source/build/shared_test"
unset LD_LIBRARY_PATH XDG_DATA_DIRS
libraries="driver device_sim render scene session"
version=$(sed -n 's/^project(thimble VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
minor=${version%.*}

# Unit tests link symbols that the libraries do not export.
cmake --preset release -B "$work/with_tests" -D BUILD_SHARED_LIBS=ON >"$work/said" 2>&1 && fail "tests with shared libraries are not refused"
tr -s ' \n' ' ' <"$work/said" | grep -q 'Add -D THIMBLE_TESTS=OFF' || fail "tests with shared libraries: $(cat "$work/said")"
rm -rf "$work/with_tests"

if [ -z "$static" ]; then
  echo "Building the static core ..."
  static=$work/static
  quiet static cmake --preset core -B "$static"
  quiet static cmake --build "$static" --parallel "$(nproc)" --target thimble
fi
if [ -z "$shared" ]; then
  echo "Building the shared core ..."
  shared=$work/shared
  begin=$SECONDS
  quiet shared cmake --preset core -B "$shared" -D BUILD_SHARED_LIBS=ON -D THIMBLE_RECORDINGS=ON
  quiet shared cmake --build "$shared" --parallel "$(nproc)" --target thimble
  echo "shared core: $((SECONDS - begin)) s from an empty folder, $(nproc) processors"
fi
quiet install cmake --install "$static" --prefix "$work/static_usr" --component dev
quiet install cmake --install "$shared" --prefix "$work/first"
mv "$work/first" "$work/usr"  # no file may name the installation folder
quiet install cmake --install "$shared" --prefix "$work/program_only" --component program
"$work/program_only/bin/thimble" --version >"$work/said" 2>&1 || fail "the component program alone: $(cat "$work/said")"

echo "Looking at the shared libraries ..."
folder=$(dirname "$(find "$work/usr" -name libthimble_driver.so)")
[ -z "$(find "$work/usr" -name 'libthimble_*.a')" ] || fail "archives are installed"
for library in $libraries; do
  file=$folder/libthimble_$library.so
  [ "$(readlink "$file")" = "libthimble_$library.so.$minor" ] || fail "$file does not lead to libthimble_$library.so.$minor"
  [ "$(readlink "$file.$minor")" = "libthimble_$library.so.$version" ] || fail "$file.$minor does not lead to version $version"
  readelf -dW "$file" >"$work/dynamic"
  grep -q "(SONAME) .*\[libthimble_$library\.so\.$minor\]" "$work/dynamic" || fail "$library: $(grep SONAME "$work/dynamic" || echo no SONAME)"
  grep -qE '\((RUNPATH|RPATH)\) .*\[\$ORIGIN\]$' "$work/dynamic" || fail "$library: $(grep PATH "$work/dynamic" || echo no run path)"
  ! ldd "$file" | grep 'not found' || fail "$library does not find what it needs"

  # Every exported symbol is in Thimble's namespace, templates included.
  nm -DP --defined-only "$file" | awk '{ print $1, $2 }' | c++filt | sed 's/@[^ ]*//' >"$work/symbols"
  ! grep -vE '^((vtable|typeinfo|typeinfo name|VTT|guard variable) for |(non-virtual |virtual )?thunk to )?thimble::' "$work/symbols" ||
    fail "$library exports the lines above, which are not in namespace thimble"
  # Hidden: functions that only the library's own sources call.
  archive=$(find "$static" -name "libthimble_$library.a")
  nm -gP --defined-only "$archive" | awk '$2 ~ /^[TDBRSG]$/' | wc -l >"$work/count"
  exported=$(grep -c ' [TDBRSG]$' "$work/symbols")
  defined=$(cat "$work/count")
  [ "$exported" -gt 10 ] && [ "$exported" -lt "$defined" ] || fail "$library exports $exported of $defined symbols"
  echo "  $library exports $exported of $defined strong symbols"
done

echo "Building the examples ..."
quiet examples cmake -S app/examples -B "$work/examples" -D CMAKE_PREFIX_PATH="$work/usr" -D CMAKE_CXX_FLAGS="-Wall -Wextra -Werror"
quiet examples cmake --build "$work/examples" --parallel "$(nproc)"
cd "$work"
examples=0
for example in examples/[0-9][0-9]_*; do
  [ -f "$example" ] && [ -x "$example" ] || continue
  "$example" >said 2>&1 || fail "$example: $(cat said)"
  readelf -dW "$example" >dynamic
  grep -q "NEEDED.*\[libthimble_[a-z_]*\.so\.$minor\]" dynamic || fail "$example needs no shared library"
  examples=$((examples + 1))
done
[ "$examples" = 11 ] || fail "$examples examples were run"

echo "Building a program on each library ..."
for library in $libraries; do
  mkdir -p "$library"
  cat >"$library/CMakeLists.txt" <<END
cmake_minimum_required(VERSION 3.25)
project(consumer LANGUAGES CXX)
# Only the sources of shared libraries use these.
if(LEAVE_OUT)
  foreach(package PkgConfig Threads fmt assimp PNG ZLIB yaml-cpp spdlog)
    set(CMAKE_DISABLE_FIND_PACKAGE_\${package} ON)
  endforeach()
endif()
find_package(thimble REQUIRED COMPONENTS $library)
add_executable(consumer consumer.cpp)
set_target_properties(consumer PROPERTIES CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
target_include_directories(consumer PRIVATE $source/tests)
target_link_libraries(consumer PRIVATE thimble::$library)
END
done
cat >driver/consumer.cpp <<'END'
#include <cstdio>
#include "thimble/driver/discovery.h"
#include "thimble/driver/fault.h"
int main() {
  (void)thimble::driver::find_arms();  // an error on a machine without USB
  std::puts(thimble::driver::name(thimble::driver::Fault::kNone).data());
}
END
cat >device_sim/consumer.cpp <<'END'
#include <cstdio>
#include "thimble/device_sim/usb/usb_fault.h"
int main() {
  const auto fault = thimble::device_sim::usb::parse_fault("no such fault");
  std::puts(fault ? "a fault" : fault.error().message.c_str());
}
END
cat >render/consumer.cpp <<'END'
#include <cstdio>
#include "thimble/render/mesh/mesh_file.h"
int main() {
  const auto mesh = thimble::render::load_mesh("no_such_file.off");
  std::puts(mesh ? "a mesh" : mesh.error().message.c_str());
}
END
cat >scene/consumer.cpp <<'END'
#include <cstdio>
#include "thimble/scene/shipped_files.h"
int main() { std::printf("%zu scenes\n", thimble::scene::shipped_scenes().size()); }
END
# An observer derives from a class of the library, in a program that hides its own symbols.
cat >session/consumer.cpp <<'END'
#include <cinttypes>
#include <cstdio>
#include "support/run_hash.h"
#include "thimble/session/session.h"
struct Observer final : thimble::session::TickObserver {
  void take(const thimble::driver::TickRecord& record) noexcept override { hash.add(record); }
  thimble::support::RunHash hash;
};
int main(int count, char** scenes) {
  for (int i = 1; i < count; ++i) {
    auto session = thimble::session::Session::open(scenes[i], {.duration = 2, .seed = 41});
    if (!session) return std::fprintf(stderr, "%s\n", session.error().message.c_str()), 1;
    Observer observer;
    if (!(*session)->add_observer(observer)) return 2;
    if ((*session)->run() != thimble::driver::ServoEnd::kDone) return 3;
    std::printf("%s 0x%" PRIx64 "\n", scenes[i], observer.hash.value());
  }
}
END
for library in $libraries; do
  quiet consumer cmake -S "$library" -B "$library/build" -D CMAKE_PREFIX_PATH="$work/usr" -D LEAVE_OUT=ON
  quiet consumer cmake --build "$library/build"
  [ "$library" = session ] || "$library/build/consumer" >said 2>&1 || fail "the program on $library: $(cat said)"
done
scene/build/consumer | grep -qE '^[1-9][0-9]+ scenes$' || fail "the shared library does not find its scenes: $(scene/build/consumer)"
# With pkg-config a program names only the shared libraries.
PKG_CONFIG_PATH=$(dirname "$(find "$work/usr" -name thimble.pc)")
export PKG_CONFIG_PATH
quiet pkg_config "${CXX:-c++}" $(pkg-config --cflags thimble) -I "$source/tests" session/consumer.cpp -o by_pkg_config $(pkg-config --libs thimble)
! pkg-config --libs thimble | grep -E 'usb|hdf5|spdlog' || fail "pkg-config names libraries that only the sources use"

echo "Comparing runs with those of the static build ..."
scenes="box sandpaper soft_coarse tin_can floating_block ice"
quiet consumer cmake -S session -B session/static -D CMAKE_PREFIX_PATH="$work/static_usr"
quiet consumer cmake --build session/static
export XDG_DATA_DIRS=$work/usr/share
session/static/consumer $scenes >static.hashes || fail "the program on the static libraries"
session/build/consumer $scenes >shared.hashes || fail "the program on the shared libraries"
LD_LIBRARY_PATH=$folder ./by_pkg_config $scenes >pkg_config.hashes || fail "the program of pkg-config"
[ "$(wc -l <static.hashes)" = 6 ] || fail "not all scenes were run: $(cat static.hashes)"
diff static.hashes shared.hashes || fail "ticks of the shared libraries are not those of the static ones"
diff static.hashes pkg_config.hashes || fail "ticks of the program of pkg-config are not those of the static libraries"
for scene in $scenes; do
  "$static/app/thimble" run "$scene" --seed 7 --duration 2 --no-view >static.txt 2>&1 || fail "static, $scene: $(cat static.txt)"
  "$work/usr/bin/thimble" run "$scene" --seed 7 --duration 2 --no-view >shared.txt 2>&1 || fail "shared, $scene: $(cat shared.txt)"
  diff static.txt shared.txt || fail "$scene: another run than that of the static program"
done
echo "shared: passed"
