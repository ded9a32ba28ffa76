#pragma once

#include "boards/chip_access.h"
#include "boards/teensy4/imx_usb.h"

namespace thimble {
namespace firmware {

/// USB controller of this board.
using UsbController = ImxUsb<ChipAccess>;

}  // namespace firmware
}  // namespace thimble
