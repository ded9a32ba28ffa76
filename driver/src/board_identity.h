#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

#include "thimble/driver/discovery.h"

namespace thimble::driver {

// Values of FoundArm::bus: the connection of a board.
inline constexpr const char* kHidBus = "USB HID";
inline constexpr const char* kSerialBus = "USB serial";
inline constexpr const char* kBulkBus = "USB bulk";
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

/// Returns whether a product string is that of many boards of a kind, as "Arduino Due" or "USB
/// Serial", so that it identifies none.
bool is_common_product(std::string_view product);

/// Returns whether a device has the properties of a described board. Those that the description
/// leaves open are not compared.
THIMBLE_EXPORT bool matches(const DescribedBoard& board, const UsbFacts& facts);

/// Returns how certain a device that matches a described board is that board.
Certainty certainty_of(const DescribedBoard& board);

/// Identifies a device; empty if it cannot be an arm. Real-time: never from the servo thread.
std::optional<BoardIdentity> identify(const UsbFacts& facts);

}  // namespace thimble::driver
