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

/// The servo loop of a run, and the observers that it tells of each tick.
class RunLoop {
 public:
  /// Adds an observer, which must outlive the loop. Precondition: the loop has not begun.
  /// Real-time: never from the servo thread.
  void add(TickObserver& observer) { observers_.push_back(&observer); }

  /// Begins the loop; its first tick is due now. All parts must outlive it, and it may not be moved
  /// from then on. Real-time: safe.
  void begin(driver::Device& device, driver::Clock& clock, driver::ForceLaw law,
             const driver::ServoSettings& settings) noexcept {
    loop_.emplace(device, clock, law, driver::TickSink(*this), settings);
  }
  /// Returns whether the loop has begun.
  bool begun() const noexcept { return loop_.has_value(); }

  /// Runs the next tick and returns why there is none any more, once the run is over
  /// (ServoLoop::tick). Precondition: the loop has begun. Real-time: safe.
  std::optional<driver::ServoEnd> tick(const std::atomic<bool>& stop) noexcept {
    return end_ = loop_->tick(stop);
  }
  /// Returns why the run ended; empty while it has not.
  std::optional<driver::ServoEnd> end() const noexcept { return end_; }

  /// Returns the observers of one tick, in the order in which they were added (the loop's sink).
  /// Real-time: safe, as each of them is.
  void operator()(const driver::TickRecord& record) noexcept {
    for (TickObserver* observer : observers_) observer->take(record);
  }

 private:
  std::vector<TickObserver*> observers_;
  std::optional<driver::ServoLoop> loop_;
  std::optional<driver::ServoEnd> end_;
};

}  // namespace thimble::session
