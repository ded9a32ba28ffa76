#pragma once

#include <atomic>
#include <cstdint>
#include <limits>

#include "thimble/driver/device.h"
#include "thimble/driver/device_state.h"

namespace thimble::driver {

/// Checks whether the enabling input is held. A button that is down from the first tick does not
/// count until it has been released once: it may be stuck, or taped. All functions are Real-time:
/// safe.
class EnablingInput {
 public:
  /// Takes the inputs that must be held.
  explicit EnablingInput(const HoldToRun& settings) noexcept : settings_(settings) {}

  /// Restarts: a button must be released first, and an earlier `hold_until` is cancelled.
  void restart() noexcept {
    released_ = false;
    until_ns_.store(kNever_ns, std::memory_order_relaxed);
  }

  /// Counts the caller's input as held until `time_ns` on the loop's clock, ns. Any thread.
  void hold_until(std::int64_t time_ns) noexcept {
    until_ns_.store(time_ns, std::memory_order_relaxed);
  }

  /// Returns whether all inputs are held in this tick.
  bool held(const DeviceState& state) noexcept {
    const bool down = (state.buttons & settings_.buttons) != 0;
    if (!down) released_ = true;
    const bool button = settings_.buttons == 0 || (down && released_);
    const bool caller =
        !settings_.by_caller || state.time_ns < until_ns_.load(std::memory_order_relaxed);
    return button && caller;
  }

 private:
  static constexpr std::int64_t kNever_ns = std::numeric_limits<std::int64_t>::min();

  HoldToRun settings_;
  bool released_ = false;  // the button was released since the start
  std::atomic<std::int64_t> until_ns_{kNever_ns};
};

}  // namespace thimble::driver
