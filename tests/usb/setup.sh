#!/usr/bin/env bash
# Installs the dependencies of the test in a virtual machine: QEMU, a static busybox, udevd and its rules, and a kernel,
# which is unpacked into build/kernel and not installed.
set -euo pipefail
cd "$(dirname "$0")/../.."
app/optional_parts.sh install usb

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
