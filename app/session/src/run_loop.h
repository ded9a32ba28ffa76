#pragma once

#include <atomic>
#include <optional>
#include <vector>

#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/force_law.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/tick_record.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Servo loop of a run with the observers of its ticks.
class RunLoop {
 public:
  /// Adds an observer, which must outlive the loop. Precondition: the loop has not started.
  /// Real-time: never from the servo thread.
  void add(TickObserver& observer) { observers_.push_back(&observer); }

  /// Starts the loop; its first tick is due now. All arguments must outlive it, and it must not be
  /// moved from then on. Real-time: safe.
  void begin(driver::Device& device, driver::Clock& clock, driver::ForceLaw law,
             const driver::ServoSettings& settings) noexcept {
    loop_.emplace(device, clock, law, driver::TickSink(*this), settings);
  }
  /// Returns whether the loop has started.
  bool begun() const noexcept { return loop_.has_value(); }

  /// Runs the next tick. Returns the end reason once the run is over (ServoLoop::tick).
  /// Precondition: the loop has started. Real-time: safe.
  std::optional<driver::ServoEnd> tick(const std::atomic<bool>& stop) noexcept {
    return end_ = loop_->tick(stop);
  }
  /// Returns the end reason; empty while the run continues.
  std::optional<driver::ServoEnd> end() const noexcept { return end_; }

  /// Returns the observers. Real-time: safe.
  const std::vector<TickObserver*>& observers() const noexcept { return observers_; }

  /// Passes a tick to the observers in the order in which they were added (the loop's sink).
  /// Real-time: safe if each of them is.
  void operator()(const driver::TickRecord& record) noexcept {
    for (TickObserver* observer : observers_) observer->take(record);
  }

 private:
  std::vector<TickObserver*> observers_;
  std::optional<driver::ServoLoop> loop_;
  std::optional<driver::ServoEnd> end_;
};

}  // namespace thimble::session
