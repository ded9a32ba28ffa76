#!/usr/bin/env bash
# Makes the Debian packages, lets lintian judge them, and looks at what they hold. With THIMBLE_LONG and as
# root it installs them into a bare Debian 12 and there touches without and with the scans, publishes topics of ROS 2, runs
# every command of the guide (of studies the first second: they take minutes and have tests of their own), and builds and
# runs the examples.
#   package_test.sh BUILD_FOLDER SOURCE_FOLDER
set -euo pipefail
build=$1 source=$2
here=$(cd "$(dirname "$0")" && pwd)
work=$(mktemp -d)
bare=$work/bare
source "$here/bare_system.sh"
leave() {
  remove_bare
  rm -rf "$work"
}
trap leave EXIT
fail() {
  echo "FAILED: $*" >&2
  exit 1
}

cd "$work"
for tool in dpkg-shlibdeps file; do
  command -v $tool >/dev/null || {
    echo "NOT TESTED: Debian packages; install dpkg-dev and file."
    exit 77
  }
done
cpack -G DEB --config "$build/CPackConfig.cmake" -B "$work" >log 2>&1 || fail "$(tail -n 40 log)"
program=$(ls "$work"/thimble_*.deb) development=$(ls "$work"/libthimble-dev_*.deb)
holds() {  # PACKAGE FILE
  dpkg-deb --contents "$1" >held
  grep -q " \./$2$" held || fail "$(basename "$1") has no $2"
}
for file in usr/bin/thimble usr/share/man/man1/thimble.1.gz usr/lib/udev/rules.d/70-thimble.rules \
  usr/share/bash-completion/completions/thimble usr/share/thimble/scenes/box.yaml \
  usr/share/doc/thimble/README.md usr/share/doc/thimble/guide/index.md usr/share/doc/thimble/guide/keys.md; do
  holds "$program" "$file"
done
for file in usr/include/thimble/driver/safety_gate.h usr/include/thimble/scene/scene_file.h \
  usr/include/thimble/session/session.h usr/lib/cmake/thimble/thimbleConfig.cmake \
  "usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)/pkgconfig/thimble.pc"; do
  holds "$development" "$file"
done
# What two packages hold, dpkg does not install.
for package in "$work"/*.deb; do dpkg-deb --fsys-tarfile "$package" | tar -t | grep -v '/$'; done | sort | uniq -d >twice
[ ! -s twice ] || fail "two packages hold $(tr '\n' ' ' <twice)"
# What thimbleConfig.cmake asks for, by the names that pkg-config and then Debian know it by.
dpkg-deb --field "$development" Depends >asked
dpkg-deb --fsys-tarfile "$development" | tar -xO --wildcards '*/thimbleConfig.cmake' >config
needed=$(sed -nE 's/^ *find_dependency\(([^ )]*).*/\1/p; s/^ *pkg_check_modules\(.* ([^ )]*)\)$/\1/p' config |
  grep -vxE 'Threads|PkgConfig' | tr '[:upper:]' '[:lower:]')
[ "$(wc -w <<<"$needed")" -ge 9 ] || fail "thimbleConfig.cmake asks for '$needed'"
for module in $needed pkg-config thimble; do
  case $module in png) module=libpng ;; esac
  library=$module
  if file=$(pkg-config --path "$module" 2>/dev/null) && [ -n "$file" ]; then
    library=$(dpkg -S "$(realpath "$file")" 2>/dev/null | cut -d : -f 1) || continue  # of nobody's package
  fi
  grep -qE "(^|, )$library( |,|$)" asked || fail "libthimble-dev does not ask for $library: $(cat asked)"
done
dpkg-deb --field "$program" Recommends >asked
for package in libcgal-demo libegl-mesa0 gnuplot-nox libjs-three libjs-dygraphs; do
  grep -q "$package" asked || fail "thimble does not recommend $package"
done
# Of the folders of the machine that built it, only what stands in every program: names of sources.
dpkg-deb --fsys-tarfile "$program" | tar -xO ./usr/bin/thimble >held
for folder in build/meshes "$source/app" "$source/build"; do
  grep -qF "$folder" <(strings held | grep -vE '\.(cpp|h|inc)$') && fail "the program names $folder"
done
dpkg-deb --field "$program" Depends | grep -c libusb-1.0-0 >held || fail "$program does not ask for libusb"
if python=$(ls "$work"/python3-thimble_*.deb 2>/dev/null); then
  holds "$python" usr/lib/python3/dist-packages/thimble/__init__.py
  holds "$python" 'usr/lib/python3/dist-packages/thimble/_core[^/]*\.so'
fi
if command -v lintian >/dev/null; then
  for package in "$work"/*.deb; do
    lintian --fail-on error "$package" 2>/dev/null || fail "lintian found errors in $package"
  done
else
  echo "NOT TESTED: what lintian says; it is not installed."
fi

[ -n "${THIMBLE_LONG:-}" ] || exit 0
if ! can_make_bare; then
  echo "NOT TESTED: the packages on a bare Debian 12; that takes root and debootstrap."
  exit 0
fi
echo "Installing into a bare Debian 12 ..."
make_bare
cp "$work"/*.deb "$bare/root/"
inside 'apt-get update -q'
inside 'apt-get install -y -q --no-install-recommends ./root/thimble_*.deb'
inside 'cd /root && thimble run water_balloon'
echo "  a mesh of ours: $(grep -m 1 '^Contact' log || head -n 1 log)"
in_bare 'cd /root && thimble run elephant' && fail "an elephant without its scan: $(cat log)"
grep -q 'libcgal-demo.*water_balloon' log || fail "without the scan the program said: $(cat log)"
in_bare 'thimble doctor' || true  # no arm is plugged in
grep -q '^advice .*meshes' log || fail "without the scans the doctor said: $(cat log)"

echo "Installing what the packages recommend ..."
inside 'apt-get install -y -q ./root/thimble_*.deb $(dpkg-deb -f /root/thimble_*.deb Recommends | tr -d ,)'
if ls "$bare"/root/python3-thimble_*.deb >/dev/null 2>&1; then
  inside 'apt-get install -y -q --no-install-recommends ./root/python3-thimble_*.deb'
fi
if ls "$bare"/root/thimble-ros2_*.deb >/dev/null 2>&1; then
  inside 'cd /root && thimble run rubber --ros2 --duration 1 | grep thimble-ros2; [ ${PIPESTATUS[0]} != 0 ]'
  inside 'apt-get install -y -q --no-install-recommends ./root/thimble-ros2_*.deb'
  inside 'cd /root && thimble run rubber --ros2 --duration 1'
  grep -qE '^ROS 2 +[1-9][0-9]* ' log || fail "with the package thimble-ros2 a run said: $(cat log)"
  echo "  topics of ROS 2: $(grep -m 1 '^ROS 2' log)"
fi
inside 'apt-get install -y -q --no-install-recommends ./root/libthimble-dev_*.deb g++ cmake make'
inside 'cd /root && thimble run elephant --report out && ls out/index.html out/force_and_depth.png && ls ~/.cache/thimble/meshes/elephant.off'
echo "  the README's first touch: $(grep -m 1 '^Contact' log || head -n 1 log)"
inside 'cd /root && thimble shot water_balloon --out shot.png && head -c 4 shot.png | grep -q PNG'

echo "Running every command of the guide, as its first page says ..."
enter=$(sed -n 's/^\(mkdir -p touch\/app .*\)$/\1/p' "$source/app/guide/pages/index.md")
[ -n "$enter" ] || fail "the guide does not say how its commands run from the packages"
inside "cd /root && $enter"
THIMBLE_LONG='' bash "$here/guide_commands.sh" "$source" >commands
ran=0
while IFS=$'\t' read -r page line; do
  if [[ $line == "python3 "* ]] && [ ! -e "$bare/usr/lib/python3/dist-packages/thimble" ]; then continue; fi
  in_bare "cd /root/touch && $line" || grep -q 'Without python3-matplotlib' log ||
    fail "in a bare Debian: $page: $line: $(tail -n 20 log)"
  ran=$((ran + 1))
done <commands
[ "$ran" -ge 30 ] || fail "only $ran commands of the guide were found"
echo "  $ran commands"
if [ -e "$bare/usr/lib/python3/dist-packages/thimble" ]; then
  awk '/^```python$/ { inside = 1; next } /^```/ { inside = 0 } inside' "$source/app/guide/pages/python.md" \
    >"$bare/root/touch/guide.py"
  inside 'cd /root/touch && python3 guide.py'
  echo "  the guide's Python"
fi
# By each: the guide's C++ by pkg-config, the examples by CMake.
sed -n '/^```cpp$/,/^```$/p' "$source/app/guide/pages/cpp.md" | sed '/^```/d' >"$bare/root/touch/guide.cpp"
inside 'cd /root/touch && c++ $(pkg-config --cflags thimble) guide.cpp -o guide $(pkg-config --libs thimble) && ./guide'
inside 'cmake -S /usr/share/doc/thimble/examples -B /root/built && cmake --build /root/built'
inside 'cd /root && for example in built/0?_*; do
          [ -x $example ] && [ -f $example ] || continue; $example || exit 1; done'
echo "  the examples: $(tail -n 1 log)"
inside 'apt-get purge -y -q thimble libthimble-dev $(dpkg-query -W -f "\${Package} " python3-thimble thimble-ros2 2>/dev/null) && ! ls /usr/share/thimble'
echo "Done."
