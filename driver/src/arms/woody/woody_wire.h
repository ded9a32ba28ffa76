#pragma once

#include "arms/woody/woody_report.h"
#include "thimble/driver/serial_arm.h"
#include "thimble/driver/wire_arm.h"

namespace thimble::driver::woody {

/// Wire format of the 8-byte HID protocol. Real-time: safe.
struct ReportWire {
  static bool decode(std::span<const std::byte> bytes, ArmReading& reading) noexcept;
  static std::size_t encode(const std::array<std::int16_t, 3>& mA,
                            std::span<std::byte, kReportCapacity> bytes) noexcept;
};

/// A WoodenHaptics arm on its mbed board.
using WoodyArm = WireArm<ReportWire, SerialArm>;

}  // namespace thimble::driver::woody
