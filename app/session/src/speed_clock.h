#pragma once

#include <atomic>
#include <cstdint>

#include "thimble/driver/clock.h"

namespace thimble::session {

/// Virtual time that passes at a multiple of real time. Ticks are bit-identical to those with
/// VirtualClock; only their pace differs. If the machine is too slow, no tick is skipped; the run
/// takes longer.
class SpeedClock final : public driver::Clock {
 public:
  /// Largest delay that a late run catches up with; the rest is ignored, ns. [chosen: an
  /// imperceptible pause of the machine]
  static constexpr std::int64_t kCatchUpMax_ns = 50'000'000;

  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void sleep_until_ns(std::int64_t time_ns) noexcept override;

  /// Sets the speed of time as a multiple of real time (> 0); any thread. Real-time: safe.
  void set_speed(double speed) noexcept { speed_.store(speed, std::memory_order_relaxed); }

 private:
  std::atomic<double> speed_{1};
  std::int64_t now_ns_ = 0;
  double due_ns_ = 0;  // Real time at which `now_ns_` was due, of CLOCK_MONOTONIC.
};

/// Returns the real time at which a virtual time, `virtual_ns` after `due_ns`, is due at `speed`.
/// If `due_ns` is more than kCatchUpMax_ns in the past, it counts as kCatchUpMax_ns ago. All of
/// CLOCK_MONOTONIC. Real-time: safe.
double paced_due(double due_ns, double world_ns, double virtual_ns, double speed) noexcept;

}  // namespace thimble::session
