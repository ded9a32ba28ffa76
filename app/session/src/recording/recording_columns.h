#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace thimble::session {

/// Is one column of a recording: one number or some of each tick.
struct RecordingColumn {
  enum class Type : std::uint8_t { kU8, kU16, kI16, kI32, kI64, kU64, kF32, kF64 };

  const char* name;   ///< Of the data set in the file.
  const char* unit;   ///< SI; "1" for numbers and flags.
  const char* about;  ///< What it is, with its frame.
  Type type;
  std::size_t width;   ///< Numbers per tick: 1, 3, or 4 of a quaternion.
  std::size_t offset;  ///< Of the first in driver::TickRecord, bytes.
  bool later = false;  ///< Older recordings do not have it; there its numbers are 0.

  /// Tells the bytes of one number.
  std::size_t element() const noexcept;
  /// Tells the bytes per tick.
  std::size_t bytes() const noexcept { return element() * width; }
};

/// Lists all columns: every field of driver::TickRecord is in one.
std::span<const RecordingColumn> recording_columns() noexcept;

}  // namespace thimble::session
