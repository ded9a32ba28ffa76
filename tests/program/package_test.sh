#!/usr/bin/env bash
# Makes the Debian packages, lets lintian judge them, and looks at what they hold. With THIMBLE_LONG and as
# root it installs them into a bare Debian 12 and there runs the program, and builds and runs the examples.
#   package_test.sh BUILD_FOLDER
set -euo pipefail
build=$1
work=$(mktemp -d)
bare=$work/bare
leave() {
  if mountpoint -q "$bare/proc"; then umount "$bare/proc"; fi
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
  usr/share/bash-completion/completions/thimble usr/share/thimble/scenes/box.yaml; do
  holds "$program" "$file"
done
for file in usr/include/thimble/driver/safety_gate.h usr/include/thimble/scene/scene_file.h \
  usr/include/thimble/session/session.h usr/lib/cmake/thimble/thimbleConfig.cmake; do
  holds "$development" "$file"
done
for library in libyaml-cpp-dev libhdf5-dev libfmt-dev thimble; do
  dpkg-deb --field "$development" Depends >held
  grep -q "$library" held || fail "libthimble-dev does not ask for $library"
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
if [ "$(id -u)" != 0 ] || ! command -v debootstrap >/dev/null; then
  echo "NOT TESTED: the packages on a bare Debian 12; that takes root and debootstrap."
  exit 0
fi
echo "Installing into a bare Debian 12 ..."
mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' 2>/dev/null | head -n 1)
debootstrap --variant=minbase --include=ca-certificates bookworm "$bare" ${mirror:+"$mirror"} >log 2>&1 ||
  fail "no bare Debian: $(tail -n 5 log)"
cp "$work"/*.deb "$bare/root/"
cp /etc/resolv.conf /etc/hosts "$bare/etc/" 2>/dev/null || true
if [ -d /etc/apt/apt.conf.d ]; then cp -n /etc/apt/apt.conf.d/* "$bare/etc/apt/apt.conf.d/"; fi
mount -t proc proc "$bare/proc"
inside() {
  chroot "$bare" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LANG=C.UTF-8 \
    DEBIAN_FRONTEND=noninteractive bash -c "$1" >log 2>&1 || fail "in a bare Debian: $1: $(tail -n 20 log)"
}
inside 'apt-get update -q'
inside 'apt-get install -y -q --no-install-recommends ./root/thimble_*.deb'
inside 'thimble run /usr/share/thimble/scenes/tin_can.yaml && thimble devices'
echo "  the program: $(grep -m 1 touched log || head -n 1 log)"
if ls "$bare"/root/python3-thimble_*.deb >/dev/null 2>&1; then
  inside 'apt-get install -y -q --no-install-recommends ./root/python3-thimble_*.deb'
  inside 'python3 -c "import thimble; print(len(thimble.run(\"tin_can\", seconds=2).time), \"ticks\")"'
  echo "  Python: $(tail -n 1 log)"
fi
inside 'apt-get install -y -q --no-install-recommends ./root/libthimble-dev_*.deb g++ cmake make'
inside 'cmake -S /usr/share/doc/thimble/examples -B /root/built && cmake --build /root/built'
inside 'cd /root && for example in built/0?_*; do
          [ -x $example ] && [ -f $example ] || continue; $example || exit 1; done'
echo "  the examples: $(tail -n 1 log)"
inside 'apt-get purge -y -q thimble libthimble-dev python3-thimble && ! ls /usr/share/thimble'
echo "Done."
