#!/usr/bin/env bash
# Installs what the virtual machine test takes, if it can; the test is skipped otherwise, with a loud
# line.
set -euo pipefail
packages=(
  qemu-system-x86     # the machine
  linux-image-amd64   # its kernel, with vhci-hcd, usbhid and hid-generic as modules
  busybox-static cpio # its small system
  udev                # the real systemd-udevd, which reads udev/70-thimble.rules
  systemd             # the rules that make uaccess give a device to who sits at it
)
exec "$(dirname "$0")/../optional_packages.sh" "the test of USB arms through a real kernel" \
  "${packages[@]}"
