#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "thimble/driver/result.h"

namespace thimble::driver {

/// Is one arm that is plugged in.
struct FoundArm {
  std::string arm;      ///< What it is ("WoodenHaptics").
  std::string bus;      ///< How it is reached ("USB HID").
  std::string address;  ///< Where it is plugged in ("bus 1, device 4").
  std::uint16_t vendor_id = 0;
  std::uint16_t product_id = 0;
};

/// Lists the arms on USB whose ids are known (driver/README.md names the sources). Needs no right
/// to open them. Fails if USB cannot be listed at all. Real-time: never from the servo thread.
Result<std::vector<FoundArm>> find_arms();

/// Tells which arm a USB id belongs to, or nullptr. Real-time: safe.
const char* arm_of_usb_id(std::uint16_t vendor_id, std::uint16_t product_id) noexcept;

}  // namespace thimble::driver
