#pragma once

#include <ostream>

#include "thimble/device_sim/usb/arm_shelf.h"

namespace thimble::device_sim::usb {

/// Names an arm of the shelf in lists of tests, where its bytes would stand.
inline void PrintTo(const ShelfEntry& entry, std::ostream* out) {
  *out << entry.name;
}

}  // namespace thimble::device_sim::usb
