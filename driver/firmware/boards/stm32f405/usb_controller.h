#pragma once

#include "boards/chip_access.h"
#include "boards/stm32f405/otg_fs.h"

namespace thimble {
namespace firmware {

/// USB controller of this board.
using UsbController = OtgFs<ChipAccess>;

}  // namespace firmware
}  // namespace thimble
