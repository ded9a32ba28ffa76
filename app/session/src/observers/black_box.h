#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Last seconds of a run, frozen after a fault until they are released. All memory is allocated and
/// touched by the constructor.
class BlackBox final : public TickObserver {
 public:
  /// Time before and after a fault that is kept, s.
  static constexpr double kBefore = 8, kAfter = 0.5;

  /// Constructs a black box for a loop of `rate` Hz (> 0). Real-time: never from the servo thread.
  explicit BlackBox(double rate);

  /// Receives one tick. Real-time: safe.
  void take(const driver::TickRecord& tick) noexcept override;

  /// Returns whether the seconds around a fault are complete. Real-time: safe.
  bool full() const noexcept { return full_.load(std::memory_order_acquire); }

  /// Returns the ticks around the fault, oldest first, and restarts; empty without a fault. While
  /// the servo runs, call it only if `full`; after its end at any time. Real-time: never from the
  /// servo thread.
  std::vector<driver::TickRecord> release();

 private:
  std::vector<driver::TickRecord> ticks_;
  std::size_t after_;  // Number of ticks to add after a fault.
  std::uint64_t taken_ = 0;
  std::size_t next_ = 0;  // Position of the next tick.
  std::size_t left_ = 0;
  bool faulty_ = false;  // True if the last tick was in fault.
  bool fault_came_ = false;
  std::atomic<bool> full_{false};
};

}  // namespace thimble::session
