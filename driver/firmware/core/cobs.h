#pragma once

#include <stddef.h>
#include <stdint.h>

namespace thimble {
namespace firmware {

// Consistent overhead byte stuffing: frames of a byte stream, separated by zero bytes [S Cheshire
// and Baker, IEEE/ACM Transactions on Networking 7(2), 1999].

/// Longest content of a frame, bytes: the self-description. Below 254, so that each code byte
/// belongs to a zero.
constexpr size_t kFrameContentMax = 64;
/// Longest frame, bytes: content, one code byte, the closing zero.
constexpr size_t kFrameMax = kFrameContentMax + 2;

/// Encodes `size` bytes, at most kFrameContentMax, as a frame with its closing zero. Returns the
/// length of the frame; 0 if the content is too long.
inline size_t encode_frame(const uint8_t* content, size_t size, uint8_t* frame) noexcept {
  if (size > kFrameContentMax) return 0;
  // Indices of 8 bits, because they are fastest on all processors.
  const uint8_t count = static_cast<uint8_t>(size);
  uint8_t code_at = 0;
  uint8_t length = 1;
  for (uint8_t i = 0; i < count; ++i) {
    const uint8_t byte = content[i];
    if (byte != 0) {
      frame[length++] = byte;
      continue;
    }
    frame[code_at] = static_cast<uint8_t>(length - code_at);
    code_at = length++;
  }
  frame[code_at] = static_cast<uint8_t>(length - code_at);
  frame[length++] = 0;
  return length;
}

/// Finds frames in a stream of bytes. Frames that are empty, too long or malformed are dropped.
class FrameReader {
 public:
  /// Takes the next byte. Returns the size of the content that it completes, or 0. The content is
  /// valid until the next call.
  size_t take(uint8_t byte) noexcept {
    if (byte != 0) {
      if (length_ < sizeof frame_) {
        frame_[length_++] = byte;
      } else {
        overlong_ = true;
      }
      return 0;
    }
    const size_t size = overlong_ ? 0 : decode();
    length_ = 0;
    overlong_ = false;
    return size;
  }

  /// Returns the content of the frame that was completed by the last byte.
  const uint8_t* content() const noexcept { return content_; }

 private:
  size_t decode() noexcept {
    uint8_t size = 0;
    uint8_t next = 0;
    while (next < length_) {
      const uint8_t code = frame_[next];
      if (code > length_ - next) return 0;
      const uint8_t end = static_cast<uint8_t>(next + code);
      for (++next; next < end; ++next) content_[size++] = frame_[next];
      if (next < length_) content_[size++] = 0;
    }
    return size;
  }

  uint8_t frame_[kFrameContentMax + 1];  // without the closing zero
  uint8_t content_[kFrameContentMax + 1];
  uint8_t length_ = 0;
  bool overlong_ = false;
};

}  // namespace firmware
}  // namespace thimble
