#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::scene {

/// Bytes of a message as an arm file or a user writes them.
struct WireBytes {
  std::vector<std::byte> bytes;  ///< The bytes; 0 where any value is allowed.
  std::vector<bool> any;         ///< For each byte: any value is allowed.
};

/// Parses bytes separated by spaces: two hexadecimal digits, `??` for any byte, a text between
/// apostrophes, and numbers such as `u16:500`, `i32:-7` or `f32:0.5` in the byte order given.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<WireBytes> parse_wire_bytes(std::string_view text, bool big_endian);

/// Parses a hexadecimal number of at most eight digits, with or without "0x"; empty if it is none
/// or above `max`.
std::optional<std::uint32_t> parse_hex(std::string_view text, std::uint32_t max);

}  // namespace thimble::scene
