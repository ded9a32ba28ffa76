#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "thimble/driver/tick_record.h"

namespace thimble::session {

/// Always keeps the last seconds, and holds them when a fault comes until somebody has taken them;
/// a sink for the servo loop. All memory is there and touched when it is made.
class BlackBox {
 public:
  /// Is how long it looks back and on, s.
  static constexpr double kBefore = 8, kAfter = 0.5;

  /// Makes a box for a loop of `rate` Hz (> 0). Real-time: never from the servo thread.
  explicit BlackBox(double rate);

  /// Takes one tick. Real-time: safe.
  void operator()(const driver::TickRecord& tick) noexcept;

  /// Tells whether a fault's seconds are ready to be taken. Real-time: safe.
  bool full() const noexcept { return full_.load(std::memory_order_acquire); }

  /// Gives the ticks around the fault, oldest first, and begins anew; none if no fault came. Beside
  /// a running servo only while `full`; after its end at any time.
  /// Real-time: never from the servo thread.
  std::vector<driver::TickRecord> take();

 private:
  std::vector<driver::TickRecord> ticks_;
  std::size_t after_;  // ticks that are still taken once a fault has come
  std::uint64_t taken_ = 0;
  std::size_t left_ = 0;
  bool faulty_ = false;  // the last tick's stage
  bool fault_came_ = false;
  std::atomic<bool> full_{false};
};

}  // namespace thimble::session
