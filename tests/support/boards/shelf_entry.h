#pragma once

#include <ostream>

#include "thimble/device_sim/usb/arm_shelf.h"

namespace thimble::device_sim::usb {

/// Prints the name of an arm of the shelf in lists of tests, instead of its bytes.
inline void PrintTo(const ShelfEntry& entry, std::ostream* out) {
  *out << entry.name;
}

}  // namespace thimble::device_sim::usb
