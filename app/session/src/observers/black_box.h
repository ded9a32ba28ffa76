#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// The last seconds of a run, held when a fault comes until somebody has taken them. All memory is
/// there and touched when it is made.
class BlackBox final : public TickObserver {
 public:
  /// How long it looks back and on, s.
  static constexpr double kBefore = 8, kAfter = 0.5;

  /// Makes a box for a loop of `rate` Hz (> 0). Real-time: never from the servo thread.
  explicit BlackBox(double rate);

  /// Takes one tick. Real-time: safe.
  void take(const driver::TickRecord& tick) noexcept override;

  /// Returns whether a fault's seconds are ready to be taken. Real-time: safe.
  bool full() const noexcept { return full_.load(std::memory_order_acquire); }

  /// Returns the ticks around the fault, oldest first, and begins anew; none if no fault came.
  /// Beside a running servo only while `full`; after its end at any time.
  /// Real-time: never from the servo thread.
  std::vector<driver::TickRecord> release();

 private:
  std::vector<driver::TickRecord> ticks_;
  std::size_t after_;  // ticks that are still taken once a fault has come
  std::uint64_t taken_ = 0;
  std::size_t next_ = 0;  // where the next tick goes
  std::size_t left_ = 0;
  bool faulty_ = false;  // the last tick's stage
  bool fault_came_ = false;
  std::atomic<bool> full_{false};
};

}  // namespace thimble::session
