#pragma once

#include <cstdint>

namespace thimble::driver {

/// A language that arms speak; the table of arms (arm_table.h) has a row for each.
enum class ArmKind : std::uint8_t {
  kWoody,        ///< WoodenHaptics on its mbed board: 8-byte HID reports.
  kPolhem,       ///< Polhem or another Haptikfabriken arm on HID: 14-byte reports.
  kHfabLine,     ///< A Teensy on USB serial, which may be a Haptikfabriken arm: text lines.
  kFalcon,       ///< Novint Falcon: packets through an FTDI converter.
  kUnsupported,  ///< Nothing that Thimble can drive.
};

}  // namespace thimble::driver
