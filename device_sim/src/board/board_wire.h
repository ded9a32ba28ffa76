#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "board/board_bytes.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/arm.h"

namespace thimble::device_sim {

// The languages of boards that report by themselves, from the boards' side: each speaks by the file
// of the driver that describes it. Everything here is Real-time: safe.

/// What a board has to say, before it is cut to what its reports have room for.
struct BoardReport {
  std::array<std::int64_t, 3> counts{};  ///< Of the motors' encoders; fine ones if they are ideal.
  std::array<std::int64_t, 3> gimbal{};  ///< Of the gimbal's encoders.
  std::uint16_t number = 0;              ///< Of the report.
  bool button = false;                   ///< The calibration button was pressed.
};

/// What a board was told.
struct BoardMessage {
  std::array<std::int32_t, 3> current_mA{};  ///< Currents of its outputs.
  std::optional<BoardCounters> counters{};   ///< A preset of its counters.
};

/// Encodes a report; returns its size.
std::size_t encode_report(const BoardReport& report, const FirmwareSettings& settings,
                          std::span<std::byte, driver::kReportCapacity> bytes) noexcept;

/// Writes to `message`, which says nothing yet, what a board was told; false, and the message left
/// alone, where the bytes have a form that the board does not know.
bool decode_message(std::span<const std::byte> bytes, const FirmwareSettings& settings,
                    BoardMessage& message) noexcept;

}  // namespace thimble::device_sim
