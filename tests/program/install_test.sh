#!/usr/bin/env bash
# Installs the build into a folder, builds the examples against it as another
# project would, runs them, and checks the other installed files.
#   install_test.sh BUILD_FOLDER EXAMPLES_FOLDER
set -euo pipefail
build=$1 examples=$2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
fail() {
  echo "FAILED: $*" >&2
  exit 1
}

cmake --install "$build" --prefix "$work/usr" >"$work/install.log" || fail "$(cat "$work/install.log")"

echo "Building the examples against the installed package ..."
cmake -S "$examples" -B "$work/examples" -G Ninja -DCMAKE_BUILD_TYPE=Debug \
  -DCMAKE_PREFIX_PATH="$work/usr" -DCMAKE_CXX_FLAGS="-Wall -Wextra -Werror" >"$work/log" 2>&1 ||
  fail "$(cat "$work/log")"
cmake --build "$work/examples" >"$work/log" 2>&1 || fail "$(cat "$work/log")"
cd "$work"
for example in "$work"/examples/[0-9][0-9]_*; do
  [ -x "$example" ] && [ -f "$example" ] || continue
  said=$("$example") || fail "$example: $said"
  echo "  $(basename "$example"): $(tail -n 1 <<<"$said")"
done
[ "$(wc -l <touch.csv)" = 2001 ] || fail "06_record left $(wc -l <touch.csv) lines"
[ "$("$work/usr/bin/thimble" export touch.h5 --csv same.csv >/dev/null && wc -l <same.csv)" -gt 1000 ] ||
  fail "09_run_a_scene left no recording that the program reads"
# Names are found next to the installed libraries; the error of an unknown name lists them.
mkdir elsewhere
(cd elsewhere && XDG_DATA_DIRS=/nonexistent "$work/examples/09_run_a_scene" no_such_scene 2>&1) >said &&
  fail "09_run_a_scene ran a scene that is not there"
grep -q 'elephant' said || fail "09_run_a_scene answered: $(cat said)"

echo "Building the programs of README.md and of the guide by pkg-config ..."
PKG_CONFIG_PATH=$(dirname "$(find "$work/usr" -name thimble.pc)")
export PKG_CONFIG_PATH
for page in README.md app/guide/pages/cpp.md; do
  sed -n '/^```cpp$/,/^```$/p' "$examples/../../$page" | sed '/^```/d' >by_pkg_config.cpp
  "${CXX:-c++}" $(pkg-config --cflags thimble) -Wall -Wextra -Werror by_pkg_config.cpp -o by_pkg_config \
    $(pkg-config --libs thimble) >log 2>&1 || fail "$page: $(cat log)"
  # As after a plain `cmake --install`: a user without files, and no scans.
  rm -rf touch.h5 nothing && mkdir nothing
  env -i HOME="$work/nothing" PATH="$PATH" XDG_DATA_DIRS="$work/usr/share" ./by_pkg_config >said 2>&1 || fail "$page: $(cat said)"
  grep -q '^Force ' said || fail "$page printed: $(cat said)"
  [ -s touch.h5 ] || fail "$page left no recording"
done
echo '#include "thimble/thimble.h"
int main() { return thimble::scene::SceneBuilder("scene").build() ? 1 : 0; }' >umbrella.cpp
"${CXX:-c++}" $(pkg-config --cflags thimble) -Wall -Wextra -Werror umbrella.cpp -o umbrella $(pkg-config --libs thimble) >log 2>&1 &&
  ./umbrella || fail "thimble/thimble.h by pkg-config: $(cat log)"
"$work/examples/09_run_a_scene" rubber third.h5 | diff said - | grep -v Replayed | grep '^[<>]' &&
  fail "by pkg-config another run"

echo "Building the program of README.md by CMake, and asking for the version ..."
mkdir consumer
sed -n '/^```cpp$/,/^```$/p' "$examples/../../README.md" | sed '/^```/d' >consumer/touch.cpp
cat >consumer/version.cpp <<'END'
#include "thimble/version.h"
#include <cstdio>
#include <cstring>
static_assert(THIMBLE_VERSION_AT_LEAST(THIMBLE_VERSION_MAJOR, THIMBLE_VERSION_MINOR, THIMBLE_VERSION_PATCH));
static_assert(THIMBLE_VERSION_AT_LEAST(0, 0, 99));
static_assert(!THIMBLE_VERSION_AT_LEAST(THIMBLE_VERSION_MAJOR, THIMBLE_VERSION_MINOR, THIMBLE_VERSION_PATCH + 1));
static_assert(!THIMBLE_VERSION_AT_LEAST(THIMBLE_VERSION_MAJOR, THIMBLE_VERSION_MINOR + 1, 0));
static_assert(!THIMBLE_VERSION_AT_LEAST(THIMBLE_VERSION_MAJOR + 1, 0, 0));
int main() {
  char numbers[32];
  std::snprintf(numbers, sizeof numbers, "%d.%d.%d", THIMBLE_VERSION_MAJOR, THIMBLE_VERSION_MINOR, THIMBLE_VERSION_PATCH);
  std::puts(THIMBLE_VERSION);
  if (thimble::version() != thimble::kVersion) return 1;
  return std::strcmp(numbers, THIMBLE_VERSION);
}
END
# One header for all components, and for the driver alone.
cat >consumer/all.cpp <<'END'
#include "thimble/thimble.h"
#include <cstdio>
int main() {
  thimble::scene::SceneBuilder scene("ball");
  scene.arm("vintage_phantom").duration(0.5);
  scene.object("ball").sphere(0.03).position({0, 0, -0.03}).stiffness(500);
  scene.hand().at(0, {0, 0, 0.005}).at(0.5, {0, 0, -0.005});
  auto run = thimble::session::Session::open(scene);
  if (!run) return std::fprintf(stderr, "%s\n", run.error().message.c_str()), 1;
  (*run)->run();
  return (*run)->ticks().back().in_contact ? 0 : 1;
}
END
mkdir driver_only
cat >driver_only/driver.cpp <<'END'
#include "thimble/thimble.h"
#if defined(THIMBLE_HAS_RENDER) || defined(THIMBLE_HAS_SCENE) || defined(THIMBLE_HAS_SESSION)
#error "a component that is not linked is defined"
#endif
int main() {
  const thimble::driver::VirtualClock clock;
  return thimble::version() == thimble::kVersion && clock.now_ns() >= 0 ? 0 : 1;
}
END
cat >driver_only/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(driver_only LANGUAGES CXX)
find_package(thimble REQUIRED COMPONENTS driver)
add_executable(driver driver.cpp)
target_link_libraries(driver PRIVATE thimble::driver)
END
cat >consumer/CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(consumer LANGUAGES CXX)
find_package(thimble REQUIRED)
add_executable(touch touch.cpp)
target_link_libraries(touch PRIVATE thimble::session)
add_executable(version version.cpp)
target_link_libraries(version PRIVATE thimble::driver)
add_executable(everything all.cpp)
target_link_libraries(everything PRIVATE thimble::session)
END
cmake -S driver_only -B driver_only/build -G Ninja -DCMAKE_PREFIX_PATH="$work/usr" >log 2>&1 && cmake --build driver_only/build >log 2>&1 ||
  fail "thimble/thimble.h with the driver alone: $(cat log)"
driver_only/build/driver || fail "the version of the linked driver is not that of the headers"
cmake -S consumer -B consumer/build -G Ninja -DCMAKE_PREFIX_PATH="$work/usr" >log 2>&1 && cmake --build consumer/build >log 2>&1 ||
  fail "$(cat log)"
rm -f touch.h5
env -i HOME="$work/nothing" PATH="$PATH" consumer/build/touch >said 2>&1 || fail "README.md by CMake: $(cat said)"
grep -q '^Force ' said || fail "README.md by CMake printed: $(cat said)"
env -i HOME="$work/nothing" PATH="$PATH" consumer/build/everything >log 2>&1 || fail "a program with thimble/thimble.h: $(cat log)"
version=$(consumer/build/version) || fail "the numbers of thimble/version.h are not those of its text: $version"
"$work/usr/bin/thimble" --version | grep -q "^thimble ${version//./\\.} " || fail "thimble/version.h says $version, the program $("$work/usr/bin/thimble" --version)"

echo "Looking at the installed program ..."
program=$work/usr/bin/thimble
"$program" run soft_coarse --arm vintage_phantom --duration 1 >"$work/log" ||
  fail "the installed program: $(cat "$work/log")"
for command in $("$program" --help | sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z-]*\).*/\1/p'); do
  zcat "$work/usr/share/man/man1/thimble.1.gz" | grep -q "^\.SS ${command//-/\\\\-}$" ||
    fail "the manual page does not know $command"
done
if command -v man >/dev/null; then
  LC_ALL=C.UTF-8 man --warnings -l "$work/usr/share/man/man1/thimble.1.gz" 2>"$work/log" >/dev/null
  [ ! -s "$work/log" ] || fail "the manual page: $(cat "$work/log")"
fi
completed=$(PATH=$work/usr/bin:$PATH bash -c '
  complete() { :; }
  . "$1"
  COMP_WORDS=(thimble ru) COMP_CWORD=1 && _thimble && echo "${COMPREPLY[*]}"
  COMP_WORDS=(thimble run --dur) COMP_CWORD=2 && _thimble && echo "${COMPREPLY[*]}"
  COMP_WORDS=(thimble run eleph) COMP_CWORD=2 && _thimble && echo "${COMPREPLY[*]}"
  COMP_WORDS=(thimble tune box --arm vint) COMP_CWORD=4 && _thimble && echo "${COMPREPLY[*]}"
  COMP_WORDS=(thimble hil --check feel) COMP_CWORD=3 && _thimble && echo "${COMPREPLY[*]}"
  COMP_WORDS=(thimble run box --clock "") COMP_CWORD=4 && _thimble && echo "${COMPREPLY[*]}"
  COMP_WORDS=(thimble run box --hold-to-run "") COMP_CWORD=4 && _thimble && echo "${COMPREPLY[*]}"' - \
  "$work/usr/share/bash-completion/completions/thimble")
[ "$completed" = "run
--duration
elephant
vintage_phantom
feel_check
virtual paced wall
button key" ] || fail "completion answered: $completed"
# zsh and fish print the same words.
export PATH=$work/usr/bin:$PATH
if command -v fish >/dev/null; then
  completed=$(fish -c "source $work/usr/share/fish/vendor_completions.d/thimble.fish
    complete -C 'thimble run --dur'; complete -C 'thimble run box --clock '")
  [ "$completed" = "--duration
paced
virtual
wall" ] || fail "completion in fish answered: $completed"
else
  echo "NOT TESTED: completion in fish; install fish."
fi
if command -v zsh >/dev/null; then
  completed=$(zsh -f -c 'fpath=($1 $fpath)
    autoload -Uz _thimble
    compadd() { print -l -- "${(@P)2}"; }
    words=(thimble run --dur) CURRENT=3; _thimble
    words=(thimble run box --clock "") CURRENT=5; _thimble' _ "$work/usr/share/zsh/vendor-completions")
  [ "$completed" = "--duration
virtual
paced
wall" ] || fail "completion in zsh answered: $completed"
else
  echo "NOT TESTED: completion in zsh; install zsh."
fi
if [ ! -d "$work/usr/lib/python3" ]; then
  echo "NOT TESTED: the Python package; it was not built."
elif ! /usr/bin/python3 -c 'import numpy' 2>/dev/null; then
  echo "NOT TESTED: the installed Python package; install python3-numpy."
else
  echo "Touching from the installed Python package ..."
  PYTHONPATH=$work/usr/lib/python3/dist-packages /usr/bin/python3 -B "$examples/08_plot_a_touch.py" \
    >"$work/log" 2>&1 || grep -q 'Without python3-matplotlib' "$work/log" || fail "$(cat "$work/log")"
  grep -q 'Contacts: [1-9]' "$work/log" || fail "08_plot_a_touch.py: $(cat "$work/log")"
  PYTHONPATH=$work/usr/lib/python3/dist-packages /usr/bin/python3 -B -c '
import sys, thimble, thimble.experiment, thimble.gym
assert all(str(one.path).startswith(sys.argv[1]) for one in thimble.scenes()), thimble.scenes()
assert thimble._study.program().startswith(sys.argv[1])' "$work/usr" || fail "the package uses files of another place"
fi
[ -f "$work/usr/lib/udev/rules.d/70-thimble.rules" ] || fail "no udev rules"

echo "Following the links of README and guide ..."
documents=$work/usr/share/doc/thimble
links=0
while IFS=: read -r page link; do
  links=$((links + 1))
  [ -e "$(dirname "$page")/$link" ] || fail "${page#"$work"/} names $link, which is not installed"
done < <(grep -oHP '\]\(\K[A-Za-z0-9_./-]+(?=(#[^)]*)?\))' "$documents"/*.md "$documents"/guide/*.md)
[ "$links" -ge 70 ] || fail "only $links links of $documents were found"
diff "$examples/../guide/pages/keys.md" "$documents/guide/keys.md" || fail "the guide has other keys"
for kind in scene arm; do
  "$program" help schema $kind | cmp - "$work/usr/share/thimble/schema/$kind.schema.json" || fail "no schema of $kind files"
done

# No path of the build folder: scans are searched for in the installation.
mkdir -p home "$work/usr/share/thimble/meshes"
printf 'OFF\n4 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 1 2 3\n3 2 0 3\n' >tetrahedron.off
in_place() { env -u THIMBLE_MESHES HOME="$work/home" XDG_CACHE_HOME="$work/home/cache" "$program" "$@"; }
if [ ! -e /usr/share/doc/libcgal-dev/data.tar.gz ]; then
  in_place run elephant >said 2>&1 && fail "the installed program took the elephant from elsewhere: $(cat said)"
  grep -q 'elephant\.off .*libcgal-demo.*/usr/share/thimble/meshes' said ||
    fail "without scans the program said: $(cat said)"
  in_place doctor >said 2>&1 || true
  grep -q '^advice .*/usr/share/thimble/meshes' said ||
    fail "without scans the doctor said: $(cat said)"
fi
sed 's/elephant\.off/tetrahedron.off/' "$work/usr/share/thimble/scenes/elephant.yaml" |
  sed 's|\.\./arms/vintage_phantom.yaml|vintage_phantom|' >pyramid.yaml
cp tetrahedron.off "$work/usr/share/thimble/meshes/"
in_place run pyramid.yaml --duration 0.1 >said 2>&1 || fail "a scan beside the installed scenes: $(cat said)"
echo "Done."
