#pragma once

#include "arms/hfab/hfab_line.h"
#include "arms/hfab/hfab_report.h"
#include "thimble/driver/serial_arm.h"
#include "thimble/driver/wire_arm.h"
#include "transports/frame_finder.h"

namespace thimble::driver::hfab {

/// Framing of lines of either direction in the byte stream.
inline constexpr Framing kLineFraming{
    .begin = std::byte{'['}, .end = std::byte{']'}, .size_max = kLineCapacity};

/// Wire format of the text protocol. An answer is rejected if its error means that the board
/// repeats old counts (kErrorStale), so that an old position is never used as a new one. Real-time:
/// safe.
struct LineWire {
  static bool decode(std::span<const std::byte> bytes, ArmReading& reading) noexcept;
  static std::size_t encode(const std::array<std::int16_t, 3>& mA,
                            std::span<std::byte, kReportCapacity> bytes) noexcept;
};

/// Wire format of the 14-byte HID protocol. Real-time: safe.
struct ReportWire {
  static bool decode(std::span<const std::byte> bytes, ArmReading& reading) noexcept;
  static std::size_t encode(const std::array<std::int16_t, 3>& mA,
                            std::span<std::byte, kReportCapacity> bytes) noexcept {
    write_output(
        {.current_mA = mA, .command = static_cast<std::int16_t>(Command::kDrive), .attributes = {}},
        bytes.first<kReportSize>());
    return kReportSize;
  }
};

/// ReportWire with counts of 32 bits in two words each: encoders d to f carry the lower halves of a
/// to c. No real arm does this. Simulated arms with ideal encoders do; their counts are 1/65536 of
/// the real ones (`with_fine_counts`). Real-time: safe.
struct FineReportWire {
  static bool decode(std::span<const std::byte> bytes, ArmReading& reading) noexcept;
  static std::size_t encode(const std::array<std::int16_t, 3>& mA,
                            std::span<std::byte, kReportCapacity> bytes) noexcept {
    return ReportWire::encode(mA, bytes);
  }
};

/// A serial arm that uses the 14-byte reports.
using HfabArm = WireArm<ReportWire, SerialArm>;

}  // namespace thimble::driver::hfab
