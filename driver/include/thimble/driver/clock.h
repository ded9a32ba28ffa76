#pragma once

#include <cstdint>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Clock of the servo loop: provides the time and waits. Times are nanoseconds since an arbitrary
/// start and never jump back.
class THIMBLE_EXPORT Clock {
 public:
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  virtual ~Clock() = default;

  /// Returns the time in ns. Real-time: safe.
  virtual std::int64_t now_ns() const noexcept = 0;

  /// Waits until `time_ns`; returns at once if that time has passed. Real-time: safe; waits no
  /// longer than requested, plus the kernel's wake-up delay.
  virtual void sleep_until_ns(std::int64_t time_ns) noexcept = 0;

  /// Returns how long the computer has been suspended since the clock was constructed, ns; 0 if the
  /// clock cannot measure it. The times of `now_ns` include it. Real-time: safe.
  virtual std::int64_t asleep_ns() const noexcept { return 0; }
};

/// Clock whose time advances only when the loop waits for it. Runs are bit-identical, and seconds
/// of contact take milliseconds. Used by one thread.
class THIMBLE_EXPORT VirtualClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void sleep_until_ns(std::int64_t time_ns) noexcept override {
    if (time_ns > now_ns_) now_ns_ = time_ns;
  }

 private:
  std::int64_t now_ns_ = 0;
};

/// CLOCK_BOOTTIME since the construction of the clock. Sleeps until shortly before the requested
/// time, then spins. Unlike CLOCK_MONOTONIC it continues during a suspend, so that a loop sees the
/// missed time. If the kernel cannot sleep on it, CLOCK_MONOTONIC is used.
///
/// Spinning reduces the median wake-up error from tens of us to below 1 us [PHYSICS 5]. It must be
/// short: the kernel throttles a SCHED_FIFO thread that keeps a core busy (950 ms of every second
/// by default). The default of 60 us is 6 % of a 1 kHz tick.
class THIMBLE_EXPORT WallClock final : public Clock {
 public:
  static constexpr std::int64_t kDefaultSpin_ns = 60'000;  ///< Default length of the spin, ns.

  /// Constructs a clock that spins for `spin_ns` (ns) before each wake-up; 0: it only sleeps.
  explicit WallClock(std::int64_t spin_ns = kDefaultSpin_ns) noexcept;

  std::int64_t now_ns() const noexcept override;
  void sleep_until_ns(std::int64_t time_ns) noexcept override;
  std::int64_t asleep_ns() const noexcept override;

 private:
  int id_;  // Id of the kernel's clock.
  std::int64_t spin_ns_;
  std::int64_t start_ns_;  // Time of that clock at construction.
  std::int64_t ahead_ns_;  // CLOCK_BOOTTIME minus CLOCK_MONOTONIC at construction.
};

}  // namespace thimble::driver
