#!/usr/bin/env bash
# Prints the newest Debian kernel whose modules simulate USB devices: one of this system, or the one in build/kernel
# (tests/usb/setup.sh). Its modules are in lib/modules next to its folder. Exits with 1 if there is none.
set -euo pipefail
here=$(cd "$(dirname "$0")/../.." && pwd)
for folder in / "$here/build/kernel/"; do
  found=
  for image in $(ls -v "$folder"boot/vmlinuz-* 2>/dev/null); do
    [ -r "$image" ] && [ -f "${folder}lib/modules/${image##*/vmlinuz-}/kernel/drivers/usb/usbip/vhci-hcd.ko" ] && found=$image
  done
  [ -z "$found" ] || { echo "$found" && exit 0; }
done
exit 1
