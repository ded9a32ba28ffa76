#pragma once

#include "boards/chip_access.h"
#include "boards/rp2040/rp_usb.h"

namespace thimble {
namespace firmware {

/// USB controller of this board.
using UsbController = RpUsb<ChipAccess>;

}  // namespace firmware
}  // namespace thimble
