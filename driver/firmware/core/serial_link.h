#pragma once

#include <stddef.h>
#include <stdint.h>

#include "cobs.h"

namespace thimble {
namespace firmware {

/// A queue of bytes between the main loop and one interrupt, or between two places of the main
/// loop. `kCapacity` is a power of two, at most 256; it holds one byte less.
template <uint16_t kCapacity>
class ByteQueue {
 public:
  /// Adds a byte; drops it if the queue is full.
  void push(uint8_t byte) noexcept {
    const uint8_t next = step(end_);
    if (next == begin_) return;
    bytes_[end_] = byte;
    end_ = next;
  }
  /// Takes a byte; returns false if there is none.
  bool pop(uint8_t& byte) noexcept {
    if (begin_ == end_) return false;
    byte = bytes_[begin_];
    begin_ = step(begin_);
    return true;
  }
  bool empty() const noexcept { return begin_ == end_; }
  /// Returns the number of bytes that can be added.
  uint16_t room() const noexcept {
    return static_cast<uint16_t>(kCapacity - 1 - ((end_ - begin_) & (kCapacity - 1)));
  }

 private:
  static_assert(kCapacity <= 256 && (kCapacity & (kCapacity - 1)) == 0, "a power of two");
  static uint8_t step(uint8_t at) noexcept {
    return static_cast<uint8_t>((at + 1) & (kCapacity - 1));
  }

  volatile uint8_t bytes_[kCapacity];
  volatile uint8_t begin_ = 0, end_ = 0;
};

/// Messages over a stream of bytes: frames in both directions.
template <uint16_t kCapacity>
class SerialLink {
 public:
  ByteQueue<kCapacity> in, out;

  /// Copies the next message into `message` (kFrameContentMax bytes); returns its size, or 0.
  size_t receive(uint8_t* message) noexcept {
    uint8_t byte;
    while (in.pop(byte)) {
      const size_t size = reader_.take(byte);
      if (size == 0 || size > kFrameContentMax) continue;
      for (size_t i = 0; i < size; ++i) message[i] = reader_.content()[i];
      return size;
    }
    return 0;
  }

  /// Sends a message as a frame. Drops it if the queue has no room for all of it.
  void send(const uint8_t* message, size_t size) noexcept {
    uint8_t frame[kFrameMax];
    const size_t length = encode_frame(message, size, frame);
    if (out.room() < length) return;
    for (size_t i = 0; i < length; ++i) out.push(frame[i]);
  }

 private:
  FrameReader reader_;
};

}  // namespace firmware
}  // namespace thimble
