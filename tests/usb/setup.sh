#!/usr/bin/env bash
# Installs what the virtual machine test takes, if it can; the test is skipped otherwise, with a loud
# line. The kernel that it boots is unpacked into build/kernel: this system is left with the one it has.
set -euo pipefail
cd "$(dirname "$0")/../.."
packages=(
  qemu-system-x86     # the machine
  busybox-static cpio # its small system
  udev                # the real systemd-udevd, which reads udev/70-thimble.rules
  systemd             # the rules that make uaccess give a device to who sits at it
)
tests/optional_packages.sh "the test of USB arms through a real kernel" "${packages[@]}"

# Debian's kernel, with vhci-hcd, usbhid and hid-generic as modules.
tests/usb/kernel.sh >/dev/null && exit 0
mkdir -p build/kernel
cd build/kernel
kernel_package() { apt-cache depends linux-image-amd64 2>/dev/null | sed -n 's/^ *Depends: \(linux-image-[0-9].*\)/\1/p'; }
[ -n "$(kernel_package)" ] || [ "$(id -u)" != 0 ] || apt-get update -q
package=$(kernel_package)
if [ -n "$package" ] && apt-get download -q "$package" 2>/dev/null && dpkg-deb -x "$package"_*.deb .; then
  rm "$package"_*.deb
  exit 0
fi
echo "NOTE: the test of USB arms through a real kernel will be SKIPPED; Debian's kernel could not be fetched" >&2
exit 1
