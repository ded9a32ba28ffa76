#pragma once

#include "arms/hfab/hfab_line.h"
#include "thimble/driver/transport.h"
#include "thimble/driver/wire_arm.h"

namespace thimble::driver::hfab {

/// Is how lines of either direction stand out of the stream.
inline constexpr Framing kLineFraming{
    .begin = std::byte{'['}, .end = std::byte{']'}, .size_max = kLineCapacity};

/// Is the text protocol as an arm sees it. An answer with an error after which the board repeats
/// old counts (kErrorStale) is rejected, so that old positions never pass for new ones.
/// Real-time: safe.
struct LineWire {
  static bool decode(std::span<const std::byte> bytes, ArmReading& reading) noexcept;
  static std::size_t encode(const std::array<std::int16_t, 3>& mA,
                            std::span<std::byte, kReportCapacity> bytes) noexcept;
};

/// Is the 14-byte HID protocol as an arm sees it; HfabArm speaks it too, with the extras of the
/// simulated arm. Real-time: safe.
struct ReportWire {
  static bool decode(std::span<const std::byte> bytes, ArmReading& reading) noexcept;
  static std::size_t encode(const std::array<std::int16_t, 3>& mA,
                            std::span<std::byte, kReportCapacity> bytes) noexcept;
};

}  // namespace thimble::driver::hfab
