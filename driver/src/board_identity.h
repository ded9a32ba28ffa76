#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "thimble/driver/discovery.h"

namespace thimble::driver {

// Values of FoundArm::bus: the connection of a board.
inline constexpr const char* kHidBus = "USB HID";
inline constexpr const char* kSerialBus = "USB serial";
/// USB vendors of Force Dimension and of the maker of the Touch [S].
inline constexpr std::uint16_t kForceDimension = 0x1451, kTouchMaker = 0x2988;

inline constexpr const char* kServiceBus = "service";

/// Properties of a USB device that the kernel reports without opening it.
struct UsbFacts {
  std::uint16_t vendor_id = 0, product_id = 0;
  std::string_view product;  ///< Product string; empty if the device has none.
  bool has_hidraw = false;   ///< The kernel's HID driver holds the device.
  HidReports hid;            ///< Report descriptor, if the device is on HID.
  bool has_tty = false;      ///< The kernel's serial driver holds the device.
};

/// Identity of a USB device, as far as it is known without opening the device.
struct BoardIdentity {
  BoardKind board = BoardKind::kOther;
  Certainty certainty = Certainty::kUnknown;
  const char* arm = "";  ///< Name of the arm, or of the kind of board ("WoodenHaptics").
  const char* bus = "";  ///< Connection ("USB HID").
};

/// Identifies a device; empty if it cannot be an arm. Real-time: never from the servo thread.
std::optional<BoardIdentity> identify(const UsbFacts& facts);

}  // namespace thimble::driver
