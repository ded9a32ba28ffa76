#pragma once

#include <cstdint>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Returns the time and waits for it; the servo loop runs on one. Times are nanoseconds since an
/// arbitrary start that never jumps back.
class THIMBLE_EXPORT Clock {
 public:
  Clock() = default;
  Clock(const Clock&) = delete;
  Clock& operator=(const Clock&) = delete;
  virtual ~Clock() = default;

  /// Returns the time in ns. Real-time: safe.
  virtual std::int64_t now_ns() const noexcept = 0;

  /// Returns at `time_ns` or later; at once if that time has passed.
  /// Real-time: safe; waits no longer than asked, plus the kernel's wake-up delay.
  virtual void sleep_until_ns(std::int64_t time_ns) noexcept = 0;

  /// Returns how long the computer has been suspended since the clock was made, ns; 0 for a clock
  /// that cannot tell. The times of `now_ns` include it. Real-time: safe.
  virtual std::int64_t asleep_ns() const noexcept { return 0; }
};

/// Time that passes only when somebody waits for it: every run is repeatable to the bit, and
/// seconds of touch take milliseconds. Used by one thread.
class THIMBLE_EXPORT VirtualClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void sleep_until_ns(std::int64_t time_ns) noexcept override {
    if (time_ns > now_ns_) now_ns_ = time_ns;
  }

 private:
  std::int64_t now_ns_ = 0;
};

/// CLOCK_BOOTTIME, counted from the clock's construction: sleeps to shortly before the wanted
/// time, then spins. It goes on while the computer is suspended, as CLOCK_MONOTONIC does not, so
/// that a loop sees the time that it missed. Where the kernel cannot sleep by it, CLOCK_MONOTONIC.
///
/// The spin buys a median wake-up error below 1 us instead of tens of us [PHYSICS 5] and must
/// stay short: the kernel throttles a SCHED_FIFO thread that keeps a core busy (950 ms of every
/// second by default). The default of 60 us is 6 % of a 1 kHz tick.
class THIMBLE_EXPORT WallClock final : public Clock {
 public:
  static constexpr std::int64_t kDefaultSpin_ns = 60'000;  ///< See above.

  /// Takes the length of the spin in ns; 0 sleeps only.
  explicit WallClock(std::int64_t spin_ns = kDefaultSpin_ns) noexcept;

  std::int64_t now_ns() const noexcept override;
  void sleep_until_ns(std::int64_t time_ns) noexcept override;
  std::int64_t asleep_ns() const noexcept override;

 private:
  int id_;  // of the kernel's clock
  std::int64_t spin_ns_;
  std::int64_t start_ns_;  // of that clock at construction
  std::int64_t ahead_ns_;  // CLOCK_BOOTTIME before CLOCK_MONOTONIC at construction
};

}  // namespace thimble::driver
