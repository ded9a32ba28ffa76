#!/usr/bin/env bash
# Makes the Debian packages, checks them with lintian, checks their contents and their sizes with dependencies, and calls
# each command of the program with and without the other packages. With THIMBLE_LONG and as
# root it installs them into a bare Debian 12. There it touches without and with the scans, publishes ROS 2 topics, runs
# every command of the guide (the first second of studies: they take minutes and have their own tests), and builds and
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
deb() { ls "$work/$1"_*.deb; }  # PACKAGE: its file
for package in *.deb; do dpkg-deb --contents "$package" >"$package.contents"; done
holds() {  # DEB FILE
  grep -q " \./$2\( -> .*\)\?$" "$1.contents" || fail "$(basename "$1") has no $2"
}
made=$(cd "$work" && ls -- *.deb | cut -d _ -f 1 | LC_ALL=C sort | tr '\n' ' ')
[[ $made == "libthimble-dev "* && ${made/python3-thimble /} == *"thimble thimble-bodies thimble-compat thimble-mesh-formats "* &&
  $made == *"thimble-studies thimble-viewer " ]] || fail "the packages are $made"
# PACKAGE FILE, one of each part.
while read -r package file; do
  holds "$(deb "$package")" "$file"
done <<'END'
thimble usr/bin/thimble
thimble usr/share/man/man1/thimble.1.gz
thimble usr/lib/udev/rules.d/70-thimble.rules
thimble usr/share/bash-completion/completions/thimble
thimble usr/share/thimble/scenes/box.yaml
thimble usr/share/thimble/schema/scene.schema.json
thimble usr/share/thimble/schema/arm.schema.json
thimble usr/share/doc/thimble/README.md
thimble usr/share/doc/thimble/guide/index.md
thimble usr/share/doc/thimble/guide/keys.md
thimble-viewer usr/libexec/thimble/thimble-viewer
thimble-viewer usr/share/man/man1/thimble-viewer.1.gz
thimble-studies usr/libexec/thimble/thimble-studies
thimble-studies usr/share/man/man1/thimble-studies.1.gz
thimble-compat usr/lib/thimble/compat/libHD.so.3
thimble-compat usr/lib/thimble/compat/libHL.so.3
thimble-compat usr/lib/thimble/compat/libdhd.so.3
thimble-mesh-formats usr/lib/thimble/thimble-mesh-formats.so
thimble-bodies usr/lib/thimble/thimble-bodies.so
END
manual() { dpkg-deb --fsys-tarfile "$(deb "$1")" | tar -xO "./usr/share/man/man1/$1.1.gz" | zcat; }  # PACKAGE
for line in 'thimble \.SS study' 'thimble See thimble\\-studies(1)' 'thimble See thimble\\-viewer(1)' 'thimble-studies \.SS study friction' \
  'thimble-viewer \.SS shot'; do
  manual "${line%% *}" >page
  grep -q "^${line#* }" page || fail "the manual page of ${line%% *} has no line ${line#* }"
done
# A folder that only one package may have: PACKAGE FOLDER.
while read -r package folder; do
  for other in "$work"/*.deb; do
    [ "$other" = "$(deb "$package")" ] || ! grep -q " \./$folder" "$other.contents" ||
      fail "$(basename "$other") has files of $folder, which belong to $package"
  done
done <<'END'
thimble usr/bin/
thimble usr/lib/udev/
thimble-compat usr/lib/thimble/compat/
libthimble-dev usr/include/
END
for file in usr/include/thimble/driver/safety_gate.h usr/include/thimble/scene/scene_file.h \
  usr/include/thimble/session/session.h usr/lib/cmake/thimble/thimbleConfig.cmake \
  "usr/lib/$(dpkg-architecture -qDEB_HOST_MULTIARCH)/pkgconfig/thimble.pc"; do
  holds "$development" "$file"
done
# dpkg refuses packages that share a file.
cat ./*.deb.contents | awk '{ print $6 }' | grep -v '/$' | sort | uniq -d >twice
[ ! -s twice ] || fail "two packages hold $(tr '\n' ' ' <twice)"
# Dependencies in thimbleConfig.cmake, by their names for pkg-config and then Debian.
dpkg-deb --field "$development" Depends >asked
dpkg-deb --fsys-tarfile "$development" | tar -xO --wildcards '*/thimbleConfig.cmake' >config
needed=$(sed -nE 's/^ *find_dependency\(([^ )]*).*/\1/p; s/^ *pkg_check_modules\(.* ([^ )]*)\)$/\1/p' config |
  grep -vxE 'Threads|PkgConfig' | tr '[:upper:]' '[:lower:]')
[ "$(wc -w <<<"$needed")" -ge 9 ] || fail "thimbleConfig.cmake asks for '$needed'"
for module in $needed pkg-config thimble; do
  case $module in png) module=libpng ;; esac
  library=$module
  if file=$(pkg-config --path "$module" 2>/dev/null) && [ -n "$file" ]; then
    library=$(dpkg -S "$(realpath "$file")" 2>/dev/null | cut -d : -f 1) || continue  # in no package
  fi
  grep -qE "(^|, )$library( |,|$)" asked || fail "libthimble-dev does not ask for $library: $(cat asked)"
done
dpkg-deb --field "$program" Recommends >asked
for package in libcgal-demo gnuplot-nox libjs-three libjs-dygraphs thimble-viewer thimble-mesh-formats thimble-bodies; do
  grep -qE "(^| )$package(,|$)" asked || fail "thimble does not recommend $package"
done
dpkg-deb --field "$(deb thimble-viewer)" Recommends | grep -q libegl-mesa0 || fail "thimble-viewer does not recommend libegl-mesa0"
version=$(dpkg-deb --field "$program" Version)
for package in "$work"/*.deb; do
  [ "$package" = "$program" ] || dpkg-deb --field "$package" Depends | grep -qF "thimble (= $version)" ||
    fail "$(basename "$package") does not ask for thimble of its version"
done

# 40 MB in units of 1024 bytes, as in Installed-Size.
bash "$source/app/debian_packages.sh" "$work"/*.deb >sizes || fail "the sizes of the packages: $(cat sizes)"
cat sizes
size=$(awk '$1 == "thimble" { print $4 }' sizes)
[ "${size:-0}" -gt 5000 ] || fail "thimble takes $size kB with what it depends on"
[ "$size" -lt $((40 * 1000 * 1000 / 1024)) ] || fail "thimble takes $size kB with what it depends on: not below 40 MB"
# The size of the other packages comes from these libraries: thimble must not need them, even indirectly.
for package in thimble-viewer thimble-mesh-formats; do
  awk -v package=$package -v limit="$size" '$1 == package && $4 > limit + 9000 { found = 1 } END { exit !found }' sizes ||
    fail "with $package as much is installed as without"
done

echo "Asking for each command, of the package thimble alone and with the others ..."
alone=$work/alone
dpkg-deb -x "$program" "$alone"
run_alone() { env -u THIMBLE_MESHES HOME="$work/home" XDG_STATE_HOME="$work/home" "$alone/usr/bin/thimble" "$@"; }
run_alone --help >help || fail "thimble alone: $(cat help)"
sed -n '/^Subcommands:/,/^$/s/^  \([a-z][a-z-]*\) .*/\1/p' help >commands_alone
[ "$(wc -l <commands_alone)" -ge 18 ] || fail "the help lists $(wc -l <commands_alone) commands"
lacking() {  # PACKAGE COMMAND...: it names the package, and the exit code is that of wrong arguments, or $ends
  local status=0
  run_alone "${@:2}" >said 2>&1 || status=$?
  [ $status = "${ends:-2}" ] || fail "without $1: thimble ${*:2} ended with $status: $(cat said)"
  [ "$(wc -l <said)" = 1 ] && grep -qF "apt install $1" said || fail "without $1: thimble ${*:2} printed: $(cat said)"
}
while read -r command; do
  case $command in
    study | bench) package=thimble-studies ;;
    shot) package=thimble-viewer ;;
    *) package= ;;
  esac
  if [ -n "$package" ]; then
    lacking "$package" "$command" anything --at all
    grep -qE "^  $command .*\(package $package\)" help || fail "the help of thimble alone does not say where $command is"
  else
    run_alone "$command" --help >said 2>&1 || fail "thimble alone: $command --help: $(cat said)"
    ! grep -q '(package ' <(head -n 1 said) || fail "thimble alone: $command is in $(cat said)"
  fi
done <commands_alone
lacking thimble-studies mesh generate ring.page
lacking thimble-viewer view recording.h5
lacking thimble-viewer view no_such_run
ends=1 lacking thimble-compat exec true
printf x >mesh.dae && lacking thimble-mesh-formats mesh mesh.dae
lacking thimble-bodies run dominoes --no-view
run_alone run water_balloon --duration 0.2 --no-view --record alone.h5 --report alone_report >said 2>&1 ||
  fail "thimble alone does not run a scene: $(cat said)"
[ -s alone.h5 ] && [ -s alone_report/report.json ] || fail "thimble alone leaves no recording and no report: $(cat said)"
for package in viewer studies compat mesh-formats bodies; do dpkg-deb -x "$(deb thimble-$package)" "$alone"; done
run_alone --help >help_of_all
! grep -qE '\(package ' <(sed -n '/^Subcommands:/,/^$/p' help_of_all) || fail "with all packages the help lists: $(cat help_of_all)"
while read -r command; do
  run_alone "$command" --help >said 2>&1 || fail "with all packages: thimble $command --help: $(cat said)"
  grep -qE '^Usage: thimble' said || fail "with all packages: thimble $command --help printed: $(cat said)"
  about=$(head -n 1 said)
  tr -s ' \n' ' ' <help_of_all | grep -qF -- " $command $about" || fail "the help describes $command otherwise than its own: $about"
done <commands_alone
run_alone study --help >said && grep -q '^  friction ' said || fail "with thimble-studies: thimble study --help: $(cat said)"
run_alone mesh generate ring.page --triangles 2000 >said 2>&1 && [ -s ring.page ] || fail "with thimble-studies: thimble mesh generate: $(cat said)"
run_alone view no_such_recording.h5 >said 2>&1 && fail "with thimble-viewer: a recording that is not there is shown"
grep -q 'no_such_recording.h5' said && ! grep -q 'apt install' said || fail "with thimble-viewer: thimble view printed: $(cat said)"
run_alone exec /bin/true >said 2>&1 || fail "with thimble-compat: thimble exec: $(cat said)"
run_alone mesh mesh.dae >said 2>&1 || true
grep -q 'the DAE file could not be read' said || fail "with thimble-mesh-formats: thimble mesh printed: $(cat said)"

echo "Installing over the package of an earlier version ..."
mkdir -p old/DEBIAN old/usr/lib/thimble/compat root/var/lib/dpkg/{info,updates}
printf 'Package: thimble\nVersion: 0.2.0\nArchitecture: %s\nMaintainer: x <x@unreachable.invalid>\nDescription: earlier\n' \
  "$(dpkg --print-architecture)" >old/DEBIAN/control
for file in libHD.so libdhd.so libdrd.so libhdPhantom.so; do : >old/usr/lib/thimble/compat/$file; done
dpkg-deb --root-owner-group -b old old.deb >log
: >root/var/lib/dpkg/status
install_into_root() {
  PATH=$PATH:/usr/sbin:/sbin dpkg --root="$work/root" --log=/dev/null --force-not-root --force-depends --auto-deconfigure "$@" >log 2>&1 ||
    fail "dpkg $*: $(cat log)"
}
install_into_root --unpack old.deb
install_into_root --configure thimble
install_into_root --unpack "$(deb thimble-compat)"
install_into_root --unpack "$program"
[ -s root/usr/lib/thimble/compat/libHD.so ] || fail "the files of thimble-compat went with the earlier package thimble"
# Of the folders of the build machine, the program may name sources only, as every program does.
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
inside 'dpkg-query -W -f "\${Installed-Size}\n" | awk "{ sum += \$1 } END { print sum }"'
before=$(cat log)
inside 'apt-get install -y -q --no-install-recommends ./root/thimble_*.deb'
# The growth equals the printed size: no missing dependency of a bare system was left out. This one has libssl3 for certificates.
inside 'dpkg-query -W -f "\${Installed-Size}\n" | awk "{ sum += \$1 } END { print sum }"'
after=$(cat log)
inside 'dpkg-query -W -f "\${Installed-Size}" libssl3'
grown=$((after - before + $(cat log)))
echo "  installed: $grown kB"
[ $((grown - size)) -le 100 ] && [ $((size - grown)) -le 100 ] || fail "$grown kB were installed, not $size"
inside 'cd /root && thimble run water_balloon'
echo "  a mesh of ours: $(grep -m 1 '^Contact' log || head -n 1 log)"
in_bare 'cd /root && thimble run elephant' && fail "an elephant without its scan: $(cat log)"
grep -q 'libcgal-demo.*water_balloon' log || fail "without the scan the program said: $(cat log)"
in_bare 'thimble doctor' || true  # no arm is plugged in
grep -q '^advice .*meshes' log || fail "without the scans the doctor said: $(cat log)"

echo "Installing what the packages recommend ..."
inside 'cd /root && apt-get install -y -q ./thimble_*.deb ./thimble-{viewer,studies,compat,mesh-formats,bodies}_*.deb \
  $(for deb in thimble_*.deb thimble-viewer_*.deb; do dpkg-deb -f $deb Recommends; done | tr -d , | tr " " "\n" | grep -v ^thimble)'
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
inside 'cd /root && thimble shot water_balloon --output shot.png && head -c 4 shot.png | grep -q PNG'

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
# With each: the guide's C++ by pkg-config, the examples by CMake.
sed -n '/^```cpp$/,/^```$/p' "$source/app/guide/pages/cpp.md" | sed '/^```/d' >"$bare/root/touch/guide.cpp"
inside 'cd /root/touch && c++ $(pkg-config --cflags thimble) guide.cpp -o guide $(pkg-config --libs thimble) && ./guide'
inside 'cmake -S /usr/share/doc/thimble/examples -B /root/built && cmake --build /root/built'
inside 'cd /root && for example in built/[0-9][0-9]_*; do
          [ -x $example ] && [ -f $example ] || continue; $example || exit 1; done'
echo "  the examples: $(tail -n 1 log)"
inside 'apt-get purge -y -q thimble libthimble-dev $(dpkg-query -W -f "\${Package} " "thimble-*" python3-thimble 2>/dev/null) && ! ls /usr/share/thimble'
echo "Done."
