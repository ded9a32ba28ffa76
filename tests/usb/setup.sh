#!/usr/bin/env bash
# Installs what the virtual machine test takes, if it can; the test is skipped otherwise, with a loud
# line. Quick when there is nothing to do.
set -euo pipefail
packages=(
  qemu-system-x86     # the machine
  linux-image-amd64   # its kernel, with vhci-hcd, usbhid and hid-generic as modules
  busybox-static cpio # its small system
  udev                # the real systemd-udevd, which reads udev/70-thimble.rules
)
missing=()
for package in "${packages[@]}"; do
  dpkg-query -W -f='${Status}' "$package" 2>/dev/null | grep -q '^install ok installed$' ||
    missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0
if [ "$(id -u)" = 0 ]; then
  as_root=()
elif command -v sudo >/dev/null && { sudo -n true 2>/dev/null || [ -t 0 ]; }; then
  as_root=(sudo)
else
  as_root=(false)
fi
echo "Installing Debian packages for the USB tests: ${missing[*]}"
"${as_root[@]}" apt-get update -q && "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive \
  apt-get install -y -q --no-install-recommends "${missing[@]}" && exit 0
echo "NOTE: the tests of USB arms through a real kernel will be SKIPPED; they need: ${missing[*]}" >&2
