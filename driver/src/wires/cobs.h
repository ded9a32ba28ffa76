#pragma once

#include <cstddef>
#include <span>

namespace thimble::driver {

// Consistent overhead byte stuffing (Cheshire and Baker, 1999), for messages below 254 bytes: no
// byte of a message is zero, and a zero ends it. Real-time: safe.

/// Encodes a message and its final zero; returns the length, at most size + 2. Precondition: at
/// most 253 bytes, and `to` has room.
inline std::size_t put_cobs(std::span<const std::byte> message, std::span<std::byte> to) noexcept {
  std::size_t code_at = 0, at = 1;
  unsigned code = 1;
  for (const std::byte byte : message) {
    if (byte == std::byte{0}) {
      to[code_at] = static_cast<std::byte>(code);
      code_at = at++;
      code = 1;
    } else {
      to[at++] = byte;
      ++code;
    }
  }
  to[code_at] = static_cast<std::byte>(code);
  to[at++] = std::byte{0};
  return at;
}

/// Decodes a message with or without its final zero into exactly `to.size()` bytes. Total: returns
/// false for any other bytes.
inline bool take_cobs(std::span<const std::byte> frame, std::span<std::byte> to) noexcept {
  if (!frame.empty() && frame.back() == std::byte{0}) frame = frame.first(frame.size() - 1);
  std::size_t at = 0, out = 0;
  while (at < frame.size()) {
    const auto code = std::to_integer<std::size_t>(frame[at++]);
    if (code == 0 || at + code - 1 > frame.size()) return false;
    for (std::size_t i = 1; i < code; ++i) {
      if (frame[at] == std::byte{0} || out == to.size()) return false;
      to[out++] = frame[at++];
    }
    if (at < frame.size()) {  // a zero of the message
      if (out == to.size()) return false;
      to[out++] = std::byte{0};
    }
  }
  return out == to.size();
}

}  // namespace thimble::driver
