#pragma once

#include <atomic>
#include <cstdint>

#include "thimble/driver/clock.h"

namespace thimble::session {

/// Virtual time that passes at the pace of the world, times a speed: ticks are those of
/// VirtualClock to the bit, only watched as they come. Where the machine is too slow none is
/// skipped; the run takes longer.
class SpeedClock final : public driver::Clock {
 public:
  /// What a run that was late catches up with at the most; the rest is let be. [chosen: a pause of
  /// the machine that nobody sees]
  static constexpr std::int64_t kCatchUpMost_ns = 50'000'000;

  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void sleep_until_ns(std::int64_t time_ns) noexcept override;

  /// Sets how fast time passes, times that of the world (> 0); any thread. Real-time: safe.
  void set_speed(double speed) noexcept { speed_.store(speed, std::memory_order_relaxed); }

 private:
  std::atomic<double> speed_{1};
  std::int64_t now_ns_ = 0;
  double due_ns_ = 0;  // when `now_ns_` was to be, of CLOCK_MONOTONIC
};

/// Returns when a time of virtual ns after `due_ns` is to be, at `speed`; as if it had been due
/// kCatchUpMost_ns ago where it was due before that. All of CLOCK_MONOTONIC. Real-time: safe.
double paced_due(double due_ns, double world_ns, double virtual_ns, double speed) noexcept;

}  // namespace thimble::session
