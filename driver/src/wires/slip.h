#pragma once

#include <cstddef>
#include <span>

namespace thimble::driver {

// Byte stuffing of SLIP (RFC 1055): c0 ends a message; within it, c0 is db dc and db is db dd.
// Real-time: safe.

inline constexpr std::byte kSlipEnd{0xc0}, kSlipEscape{0xdb};

/// Encodes a message and its final c0; returns the length, at most 2 * size + 1. Precondition: `to`
/// has room.
inline std::size_t put_slip(std::span<const std::byte> message, std::span<std::byte> to) noexcept {
  std::size_t at = 0;
  for (const std::byte byte : message) {
    const bool escaped = byte == kSlipEnd || byte == kSlipEscape;
    if (escaped) to[at++] = kSlipEscape;
    to[at++] = !escaped ? byte : byte == kSlipEnd ? std::byte{0xdc} : std::byte{0xdd};
  }
  to[at++] = kSlipEnd;
  return at;
}

/// Decodes a message with or without its final c0 into exactly `to.size()` bytes. Total: returns
/// false for any other bytes.
inline bool take_slip(std::span<const std::byte> frame, std::span<std::byte> to) noexcept {
  if (!frame.empty() && frame.back() == kSlipEnd) frame = frame.first(frame.size() - 1);
  std::size_t out = 0;
  for (std::size_t at = 0; at < frame.size(); ++at) {
    std::byte byte = frame[at];
    if (byte == kSlipEnd || out == to.size()) return false;
    if (byte == kSlipEscape) {
      if (++at == frame.size()) return false;
      if (frame[at] != std::byte{0xdc} && frame[at] != std::byte{0xdd}) return false;
      byte = frame[at] == std::byte{0xdc} ? kSlipEnd : kSlipEscape;
    }
    to[out++] = byte;
  }
  return out == to.size();
}

}  // namespace thimble::driver
