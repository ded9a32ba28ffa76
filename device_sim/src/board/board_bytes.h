#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "thimble/driver/arm.h"

namespace thimble::device_sim {

/// Values for the counters of a board: motor encoders, then gimbal encoders.
using BoardCounters = std::array<std::int32_t, 6>;

/// A report of a board.
struct BoardBytes {
  std::size_t size = 0;                                  ///< Number of valid bytes.
  std::array<std::byte, driver::kReportCapacity> bytes;  ///< The first `size` bytes are valid.

  /// Returns the valid bytes. Real-time: safe.
  operator std::span<const std::byte>() const noexcept {  // NOLINT(*-explicit-*)
    return std::span<const std::byte>(bytes).first(size);
  }
};

}  // namespace thimble::device_sim
