#pragma once

#include <stdint.h>

namespace thimble {
namespace firmware {

/// Extends a counter of 16 bits, as timers have, to 32 bits. Read it at least once per 32767
/// counts.
class WideCounter {
 public:
  /// Takes the present value of the counter, and returns the extended one.
  int32_t take(uint16_t value) noexcept {
    const int16_t step = static_cast<int16_t>(static_cast<uint16_t>(value - last_));
    last_ = value;
    wide_ = static_cast<int32_t>(static_cast<uint32_t>(wide_) +
                                 static_cast<uint32_t>(static_cast<int32_t>(step)));
    return wide_;
  }

 private:
  uint16_t last_ = 0;
  int32_t wide_ = 0;
};

/// Counts the edges of two quadrature signals by software, for boards without a counter. Call it in
/// the interrupt of each edge.
class Quadrature {
 public:
  /// Takes the levels of A (bit 1) and B (bit 0). Counts up if A leads B. Returns false if both
  /// have changed, so that an edge was missed.
  bool take(uint8_t levels) noexcept {
    // Steps by old and new levels; 2: both have changed.
    static constexpr int8_t kStep[16] = {0, -1, 1, 2, 1, 0, 2, -1, -1, 2, 0, 1, 2, 1, -1, 0};
    const int8_t step = kStep[(levels_ << 2 | levels) & 15];
    levels_ = levels & 3;
    if (step == 2) return false;
    count_ = static_cast<int32_t>(static_cast<uint32_t>(count_) +
                                  static_cast<uint32_t>(static_cast<int32_t>(step)));
    return true;
  }

  int32_t count() const noexcept { return count_; }

 private:
  uint8_t levels_ = 0;
  volatile int32_t count_ = 0;
};

/// An absolute encoder of 14 bits on SPI with the frames of the AS5047D: bit 15 is the parity, bit
/// 14 the error flag, bits 13 to 0 the angle [S ams AS5047D datasheet, "SPI read frame"].
class As5047 {
 public:
  /// Command that reads the compensated angle: register 0x3fff, read bit, even parity [S].
  static constexpr uint16_t kReadAngle = 0xffff;

  /// Takes a frame. Returns false, and leaves the count unchanged, if the parity is wrong or the
  /// error flag is set. The count follows the angle over whole turns, if it moves by less than half
  /// a turn from frame to frame; the first frame determines the turn.
  bool take(uint16_t frame) noexcept {
    uint16_t parity = frame;
    parity = static_cast<uint16_t>(parity ^ (parity >> 8));
    parity = static_cast<uint16_t>(parity ^ (parity >> 4));
    parity = static_cast<uint16_t>(parity ^ (parity >> 2));
    parity = static_cast<uint16_t>(parity ^ (parity >> 1));
    if ((parity & 1) != 0 || (frame & 0x4000) != 0) return false;
    // In the upper 14 of 16 bits, so that the difference wraps as the angle does.
    count_ = turns_.take(static_cast<uint16_t>(frame << 2)) / 4;
    return true;
  }

  int32_t count() const noexcept { return count_; }

 private:
  WideCounter turns_;
  int32_t count_ = 0;
};

}  // namespace firmware
}  // namespace thimble
