#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "thimble/driver/discovery.h"

namespace thimble::driver {

// How a board is reached, as FoundArm::bus tells it.
inline constexpr const char* kHidBus = "USB HID";
inline constexpr const char* kSerialBus = "USB serial";
/// USB vendors of Force Dimension and of the maker of the Touch [S].
inline constexpr std::uint16_t kForceDimension = 0x1451, kTouchMaker = 0x2988;

inline constexpr const char* kServiceBus = "service";

/// What the kernel tells of a USB device without opening it.
struct UsbFacts {
  std::uint16_t vendor_id = 0, product_id = 0;
  std::string_view product;  ///< Its product string; empty if it has none.
  bool has_hidraw = false;   ///< The kernel's HID driver has it.
  HidReports hid;            ///< Its report descriptor, if it is on HID.
  bool has_tty = false;      ///< The kernel's serial driver has it.
};

/// What a USB device is, as far as it can be told without opening it.
struct BoardIdentity {
  BoardKind board = BoardKind::kOther;
  Certainty certainty = Certainty::kUnknown;
  const char* arm = "";  ///< What it is, or what kind of board ("WoodenHaptics").
  const char* bus = "";  ///< How it is reached ("USB HID").
};

/// Returns what a device is, or nothing if it cannot be an arm. Real-time: never from the servo
/// thread.
std::optional<BoardIdentity> identify(const UsbFacts& facts);

}  // namespace thimble::driver
