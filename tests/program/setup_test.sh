#!/usr/bin/env bash
# app/setup.sh and tests/run.sh on a small project, with package tools that install nothing. Installed and removed packages
# are noticed, an absent part fails, and only tests that depend on the wall clock are repeated.
#   setup_test.sh SOURCE_FOLDER
set -euo pipefail
source=$1
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset THIMBLE_WITHOUT THIMBLE_LONG THIMBLE_SEED MAKEFLAGS CTEST_PARALLEL_LEVEL
fail() {
  echo "FAILED: $*" >&2
  exit 1
}

# A Debian system whose packages are lines of a file.
export FAKE=$work/debian
mkdir -p "$FAKE/bin"
: >"$FAKE/installed"
: >"$FAKE/unavailable"
cat >"$FAKE/bin/dpkg-query" <<'END'
#!/usr/bin/env bash
status=0
for package in "${@:3}"; do
  if ! grep -qxF "$package" "$FAKE/installed"; then
    status=1
  elif [[ $2 == *'${Status}'* ]]; then
    printf 'install ok installed'
  else
    echo "installed $package 1.0"
  fi
done
exit $status
END
cat >"$FAKE/bin/apt-get" <<'END'
#!/usr/bin/env bash
[ "$1" = install ] || exit 0
for argument in "${@:2}"; do
  [[ $argument == -* ]] || packages+=("$argument")
done
! printf '%s\n' "${packages[@]}" | grep -qxF -f "$FAKE/unavailable" || exit 100
printf '%s\n' "${packages[@]}" >>"$FAKE/installed"
END
printf '#!/usr/bin/env bash\n[ "$1" = -n ] || exec "$@"\n' >"$FAKE/bin/sudo"
chmod +x "$FAKE"/bin/*
export PATH=$FAKE/bin:$PATH

# A project whose parts only need their packages; each part has a test.
project=$work/project
mkdir -p "$project"/{app,tests/usb}
cp "$source"/app/{setup.sh,optional_parts.sh,optional_parts.list,debian_packages.sh} "$project/app/"
cp "$source/tests/run.sh" "$project/tests/"
cd "$project"
printf '#!/usr/bin/env bash\nmkdir -p build/meshes && touch build/meshes/elephant.off\n' >app/fetch_meshes.sh
printf '#!/usr/bin/env bash\nexit 0\n' >tests/usb/setup.sh
printf '#!/usr/bin/env bash\nexit 1\n' >tests/usb/kernel.sh
chmod +x app/fetch_meshes.sh tests/usb/*.sh
cat >CMakePresets.json <<'END'
{
  "version": 6,
  "configurePresets": [{"name": "release", "generator": "Ninja", "binaryDir": "${sourceDir}/build/${presetName}"}],
  "buildPresets": [{"name": "release", "configurePreset": "release"}],
  "testPresets": [{"name": "release", "configurePreset": "release", "output": {"outputOnFailure": true}}]
}
END
cat >parts.sh <<'END'
app/optional_parts.sh state >"$1/optional_packages.txt"
sed -E '/^#/d; s/ *\| */|/g' app/optional_parts.list | while IFS='|' read -r key by packages part; do
  state=on
  for package in $packages; do grep -q "^$package " "$1/optional_packages.txt" || state=missing; done
  echo "$state|$key|$by|$part|"
done >"$1/optional_parts.txt"
sed -n 's/^on|\([^|]*\)|.*/\1/p' "$1/optional_parts.txt"
END
cat >fails.sh <<'END'
echo ran >>"$FAKE/$1.ran"
[ "$(wc -l <"$FAKE/$1.ran")" -gt "$(cat "$FAKE/$1.failures" 2>/dev/null || echo 0)" ] || { echo "$2 is late" && exit 1; }
END
cat >CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(parts LANGUAGES NONE)
file(APPEND "$ENV{FAKE}/configured" "once more\n")
foreach(target thimble thimble_product thimble_demo)
  add_custom_target(${target})
endforeach()
enable_testing()
execute_process(COMMAND bash parts.sh "${CMAKE_BINARY_DIR}" WORKING_DIRECTORY "${CMAKE_SOURCE_DIR}"
                OUTPUT_VARIABLE parts COMMAND_ERROR_IS_FATAL ANY)
string(REPLACE "\n" ";" parts "${parts}")
foreach(part ${parts})
  add_test(NAME part.${part} COMMAND ${CMAKE_COMMAND} -E true)
endforeach()
# Tests that fail as often as a file states.
foreach(name clock/slow.one clock.slow plain)
  string(REPLACE "/" "_" file ${name})
  add_test(NAME ${name} COMMAND bash "${CMAKE_SOURCE_DIR}/fails.sh" ${file} ${name})
endforeach()
set_tests_properties(clock/slow.one clock.slow PROPERTIES LABELS "module;wall_clock")
END

configured() { wc -l <"$FAKE/configured"; }
expect_configured() {  # TIMES WHEN
  [ "$(configured)" = "$1" ] || fail "$2: configured $(configured) times, not $1"
}
run() {  # STATUS COMMAND...: the output is in the file said
  local status=0
  "${@:2}" >"$work/said" 2>&1 || status=$?
  [ $status = "$1" ] || fail "$(printf '%s ' "${@:2}") ended with $status, not $1: $(cat "$work/said")"
}
says() { grep -qE -- "$1" "$work/said" || fail "no line '$1' in: $(cat "$work/said")"; }
silent_on() { ! grep -qE -- "$1" "$work/said" || fail "a line '$1' in: $(cat "$work/said")"; }
names() { ctest --test-dir "$1" -N | sed -n 's/^ *Test *#[0-9]*: //p' | sort; }

echo "The demo first, then everything ..."
run 0 app/setup.sh release thimble_demo
expect_configured 1 "an empty folder"
says '^Optional parts of build/release'
says '^ +missing +python +Python package'
says '^ +on +bags +ROS bags'
run 0 app/setup.sh release thimble_demo
expect_configured 1 "nothing has changed"
run 0 app/setup.sh release thimble
expect_configured 2 "after the Python packages were installed"
says '^ +on +python +Python package'
for package in pybind11-dev python3-numpy file dpkg-dev; do
  grep -qxF $package "$FAKE/installed" || fail "app/setup.sh release thimble does not install $package"
done
run 0 tests/run.sh release
expect_configured 3 "after tests/run.sh has installed packages"
for key in python ros2 mpi fastdds mpfr valgrind; do
  says "^ +on +$key "
done
silent_on '^ +missing'
cmake --preset release -B build/fresh >/dev/null
diff <(names build/release) <(names build/fresh) >&2 || fail "other tests than a build folder configured with all packages"
: >"$FAKE/configured"
run 0 tests/run.sh release
expect_configured 0 "nothing has changed since tests/run.sh"
run 0 tests/run.sh
says '^== Tests: release$'
silent_on '^== Tests: [^r]'  # sanitizers run only with --sanitizers and --long
says '^ +[0-9]+ s  installation$'
says '^ +[0-9]+ s  build release$'
says '^ +[0-9]+ s  tests release$'

echo "A part that cannot be installed ..."
echo mkdocs >"$FAKE/unavailable"
sed -i '/^mkdocs$/d; /^ffmpeg$/d' "$FAKE/installed"
run 1 tests/run.sh release
expect_configured 1 "after a package was removed"
says '^NOTE: guide as web pages: .*mkdocs'
says '^ +missing +guide '
says '^ +on +animations '  # the other package is still installed
says '^Absent in release: guide\.'
says '100% tests passed'
run 0 tests/run.sh --without guide release
says '^ +missing +guide '
run 0 env THIMBLE_WITHOUT=guide tests/run.sh release
run 2 tests/run.sh --without nonsense release
says "Unknown optional part 'nonsense'"
run 2 env THIMBLE_WITHOUT=program app/setup.sh release thimble
says "Unknown optional part 'program'"
: >"$FAKE/unavailable"

echo "Tests that depend on the wall clock ..."
rm -f "$FAKE"/*.ran
echo 2 >"$FAKE/clock_slow.one.failures"
echo 1 >"$FAKE/clock.slow.failures"
run 0 tests/run.sh release
says '^Passed at a further attempt in release: clock/slow\.one$'
says '^Passed at a further attempt in release: clock\.slow$'
[ "$(wc -l <"$FAKE/clock_slow.one.ran") $(wc -l <"$FAKE/clock.slow.ran") $(wc -l <"$FAKE/plain.ran")" = "3 2 1" ] ||
  fail "attempts: $(wc -l "$FAKE"/*.ran)"
rm -f "$FAKE"/*.ran
echo 1 >"$FAKE/plain.failures"
run 1 tests/run.sh release
says '^Failed in release: plain$'
says '^plain is late$'
silent_on '^Failed in release: clock'
[ "$(wc -l <"$FAKE/plain.ran")" = 1 ] || fail "a test that does not depend on the wall clock was repeated"
rm -f "$FAKE"/*.ran "$FAKE/plain.failures"
echo 3 >"$FAKE/clock.slow.failures"
run 1 tests/run.sh release
says '^Failed in release: clock\.slow$'
[ "$(wc -l <"$FAKE/clock.slow.ran")" = 3 ] || fail "not three attempts: $(wc -l <"$FAKE/clock.slow.ran")"

echo "Random cases ..."
rm -f "$FAKE"/*.ran "$FAKE/clock.slow.failures"
run 0 tests/run.sh release
silent_on 'THIMBLE_SEED'
run 0 tests/run.sh --long release
says '^Random cases: THIMBLE_SEED=[0-9]+ repeats them'
run 0 env THIMBLE_SEED=77 tests/run.sh --long release
says '^Random cases: THIMBLE_SEED=77 repeats them'

echo "What CMake found before ..."
mkdir -p "$work/search/app" "$work/prefix"/{bin,lib/pkgconfig,lib/cmake/Fake}
cp "$source"/app/{optional_parts.cmake,optional_parts.sh,optional_parts.list,debian_packages.sh} "$work/search/app/"
cd "$work/search"
cat >CMakeLists.txt <<'END'
cmake_minimum_required(VERSION 3.25)
project(search LANGUAGES NONE)
include(app/optional_parts.cmake)
find_package(Fake QUIET)
find_program(FAKE_PROGRAM thimble-fake PATHS "$ENV{PREFIX}/bin")
find_package(PkgConfig REQUIRED)
pkg_check_modules(FAKE_MODULE thimble-fake)
set(found "")
foreach(name Fake_FOUND FAKE_PROGRAM FAKE_MODULE_FOUND)
  if(${name})
    list(APPEND found ${name})
  endif()
endforeach()
file(WRITE "${CMAKE_BINARY_DIR}/found.txt" "${found}")
file(WRITE "${THIMBLE_PACKAGES_FILE}" "${THIMBLE_PACKAGES}")
END
export PREFIX=$work/prefix PKG_CONFIG_PATH=$work/prefix/lib/pkgconfig
search() { cmake -B "$work/searched" -DCMAKE_PREFIX_PATH="$PREFIX" . >"$work/said" 2>&1 || fail "$(cat "$work/said")"; }
search
[ -z "$(cat "$work/searched/found.txt")" ] || fail "found before it was there: $(cat "$work/searched/found.txt")"
touch "$PREFIX/lib/cmake/Fake/FakeConfig.cmake"
printf '#!/bin/sh\n' >"$PREFIX/bin/thimble-fake" && chmod +x "$PREFIX/bin/thimble-fake"
printf 'Name: fake\nDescription: fake\nVersion: 1\n' >"$PREFIX/lib/pkgconfig/thimble-fake.pc"
search
[ "$(cat "$work/searched/found.txt")" = "Fake_FOUND;FAKE_PROGRAM;FAKE_MODULE_FOUND" ] ||
  fail "found after it was installed: $(cat "$work/searched/found.txt")"
rm -r "${PREFIX:?}"/*/*
sed -i '/^mkdocs$/d; /^ffmpeg$/d' "$FAKE/installed"
search
[ -z "$(cat "$work/searched/found.txt")" ] || fail "found after it was removed: $(cat "$work/searched/found.txt")"
echo "PASS"
