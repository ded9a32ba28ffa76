#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "board/board_bytes.h"
#include "firmware/core/controller.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/arm.h"

namespace thimble::device_sim {

// Protocols of boards that send reports unasked, from the board's side. Each uses the driver's file
// that describes it. Everything here is Real-time: safe.

/// Content of a report, before it is cut to the width of the report's fields.
struct BoardReport {
  std::array<std::int64_t, 3> counts{};  ///< Counts of the motor encoders; fine if these are ideal.
  std::array<std::int64_t, 3> gimbal{};  ///< Counts of the gimbal encoders.
  std::uint16_t number = 0;              ///< Number of the report.
  bool button = false;                   ///< The calibration button was pressed.
};

/// Content of a message to a board.
struct BoardMessage {
  std::array<std::int32_t, 3> current_mA{};  ///< Currents of the outputs, mA.
  std::optional<BoardCounters> counters{};   ///< Preset of the counters.
};

/// Encodes a report; returns its size.
std::size_t encode_report(const BoardReport& report, const FirmwareSettings& settings,
                          std::span<std::byte, driver::kReportCapacity> bytes) noexcept;

/// Reads the values that the reference firmware measures from a report that `encode_report` wrote
/// with FirmwareSettings::reference: counters and button.
void unpack_inputs(std::span<const std::byte> bytes, firmware::Inputs& inputs) noexcept;

/// Decodes a message into `message`, which must be empty. Returns false, and leaves `message`
/// unchanged, if the form of the bytes is unknown to the board.
bool decode_message(std::span<const std::byte> bytes, const FirmwareSettings& settings,
                    BoardMessage& message) noexcept;

}  // namespace thimble::device_sim
