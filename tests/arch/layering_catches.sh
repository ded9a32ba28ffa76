#!/usr/bin/env bash
# Proves that layering.sh can fail: plants one forbidden include of each kind in a copy.
#   tests/arch/layering_catches.sh SOURCE_DIR
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
copy=$(mktemp -d)
trap 'rm -rf "$copy"' EXIT

plant() {
  rm -rf "${copy:?}"/*
  (cd "$1" && tar -c driver/include driver/src device_sim render) | tar -x -C "$copy"
  echo "#include $3" >>"$copy/$2"
  if bash "$here/layering.sh" "$copy" >/dev/null; then
    echo "layering.sh did not notice '#include $3' in $2"
    exit 1
  fi
}
bash "$here/layering.sh" "$1"
plant "$1" driver/include/thimble/driver/fault.h '<spdlog/spdlog.h>'
plant "$1" driver/include/thimble/driver/fault.h '<libusb-1.0/libusb.h>'
plant "$1" driver/src/fault.cpp '"thimble/render/touch.h"'
plant "$1" device_sim/include/thimble/device_sim/settings.h '"thimble/render/touch.h"'
plant "$1" device_sim/include/thimble/device_sim/settings.h '"thimble/driver/device.h"'
plant "$1" render/include/thimble/render/touch.h '"thimble/driver/transport.h"'
plant "$1" render/include/thimble/render/touch.h '"thimble/driver/arms/hfab/hfab_arm.h"'
plant "$1" render/include/thimble/render/touch.h '"thimble/device_sim/settings.h"'
