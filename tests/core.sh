#!/usr/bin/env bash
# Tests builds without optional parts (CMakeLists.txt).
#   tests/core.sh [--each]
#     (nothing)  configures a build without each single part; builds the preset core in an empty folder, prints the
#                seconds, touches a scene with it, calls missing commands, and builds programs with its installed libraries;
#                then the same with shared libraries (shared.sh)
#     --each     also builds the program without each single part, and the tests of app that follow the option (over an
#                hour)
set -euo pipefail
cd "$(dirname "$0")/.."
source=$PWD
source tests/build_check.sh
empty_folder "$source/build/core_test"

# Options whose tests are in programs that link other parts too.
tested_without="MESH_FORMATS RECORDINGS BAGS WEB"
for part in BUILD_APP MESH_FORMATS RECORDINGS BAGS BULLET FORMULAS VIEW WEB STUDIES COMMISSIONING COMPAT ROS2 PYTHON MPI BENCHMARKS TESTS; do
  echo "Configuring without THIMBLE_$part ..."
  quiet "$part" cmake --preset release -B "$work/$part" -D "THIMBLE_$part=OFF"
  if [ "${1:-}" = --each ]; then
    case $part in
      BUILD_APP) targets="thimble_render tests_driver" ;;
      *) targets=thimble ;;
    esac
    [[ " $tested_without " != *" $part "* ]] || targets+=" tests_app"
    # shellcheck disable=SC2086
    quiet "$part" cmake --build "$work/$part" --parallel "$(nproc)" --target $targets
    [ "$part" = BUILD_APP ] || quiet "$part" "$work/$part/app/thimble" run box --duration 0.3 --no-view
  fi
  rm -rf "${work:?}/$part"
done

echo "Building core ..."
begin=$SECONDS
quiet core cmake --preset core -B "$work/core"
quiet core cmake --build "$work/core" --parallel "$(nproc)" --target thimble
echo "core: $((SECONDS - begin)) s from an empty folder, $(nproc) processors"
thimble=$work/core/app/thimble
for library in hdf5 assimp sqlite GL epoxy boost python mpi; do
  ! ldd "$thimble" | grep -i "lib$library" || fail "core loads $library"
done
cd "$work"
"$thimble" run box --duration 1 --no-view --report "$work/report" >said 2>&1 || fail "core does not run a scene: $(cat said)"
grep -q '^Force ' said || fail "core prints no summary: $(cat said)"
[ -s report/report.json ] || fail "core writes no report"
lacks() {  # lacks OPTION COMMAND...: the error names the option
  local status=0
  "$thimble" "${@:2}" >said 2>&1 || status=$?
  [ $status = 2 ] || fail "thimble ${*:2}: exit code $status: $(cat said)"
  grep -q "THIMBLE_$1" said || fail "thimble ${*:2} does not name THIMBLE_$1: $(cat said)"
}
lacks VIEW shot box
lacks STUDIES study accuracy
lacks STUDIES bench box
lacks COMMISSIONING hil
lacks COMMISSIONING identify
lacks COMPAT exec true
lacks RECORDINGS run box --duration 0.2 --no-view --record run.h5
touch some.dae some.db3
lacks MESH_FORMATS mesh some.dae
lacks BAGS replay some.db3 --scene box
lacks WEB view --web --for 1
lacks ROS2 run box --duration 0.2 --no-view --ros2
echo "Building programs on the installed libraries ..."
quiet install cmake --install "$work/core" --prefix "$work/usr" --component dev
mkdir -p driver_only
cat >driver_only/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(driver_only LANGUAGES CXX)
# Packages that the driver does not need cannot be found here.
foreach(package fmt assimp PNG ZLIB yaml-cpp spdlog)
  set(CMAKE_DISABLE_FIND_PACKAGE_${package} ON)
endforeach()
find_package(thimble REQUIRED COMPONENTS driver)
if(TARGET thimble::render OR TARGET thimble::scene)
  message(FATAL_ERROR "more than the driver")
endif()
add_executable(arms arms.cpp)
target_link_libraries(arms PRIVATE thimble::driver)
END
cat >driver_only/arms.cpp <<'END'
#include <cstdio>
#include <string>
#include "thimble/driver/discovery.h"
int main() {
  const auto arms = thimble::driver::find_arms();  // an error on a machine without USB
  std::printf("arms: %s\n", arms ? std::to_string(arms->size()).c_str() : arms.error().message.c_str());
}
END
quiet consumer cmake -S driver_only -B driver_only/build -D CMAKE_PREFIX_PATH="$work/usr"
quiet consumer cmake --build driver_only/build
driver_only/build/arms | grep -q '^arms: .' || fail "a program of the driver alone does not run"
"$source/tests/shared.sh" "$work/core"
echo "core: passed"
