#pragma once

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "thimble/driver/clock.h"

namespace thimble::ros2 {

/// Synchronises a run in virtual time with its topics: the topics permit ticks, the run computes
/// them and waits, and the topics of each arm publish them. Never for a run on a real arm. Any
/// thread.
class RosSteps {
 public:
  /// Sets the number of arms with topics; call it before any of them publishes.
  void expect(std::size_t arms) {
    const std::scoped_lock lock(mutex_);
    published_.assign(arms, 0);
  }
  /// Permits ticks up to the total number `ticks`; does nothing if they are already permitted.
  void permit(std::uint64_t ticks) {
    const std::scoped_lock lock(mutex_);
    permitted_ = std::max(permitted_, ticks);
    changed_.notify_all();
  }
  /// Reports that a total of `ticks` ticks are done.
  void done(std::uint64_t ticks) {
    const std::scoped_lock lock(mutex_);
    done_ = ticks;
    if (done_ >= permitted_) changed_.notify_all();
  }
  /// Waits until a permitted tick is not yet done, at most for `longest`. Returns whether there is
  /// one.
  bool wait_for_permit(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, longest, [this] { return permitted_ > done_; });
  }
  /// Waits until all permitted ticks are done, at most for `longest`. Returns the number of ticks
  /// done.
  std::uint64_t wait_for_ticks(std::chrono::milliseconds longest) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, longest, [this] { return done_ >= permitted_; });
    return done_;
  }
  /// Returns whether all permitted ticks are done.
  bool idle() {
    const std::scoped_lock lock(mutex_);
    return done_ >= permitted_;
  }
  /// Reports that the topics of an arm have published a total of `ticks` ticks.
  void set_published(std::size_t arm, std::uint64_t ticks) {
    const std::scoped_lock lock(mutex_);
    published_[arm] = ticks;
  }
  /// Returns whether the topics of all arms have published a total of `ticks` ticks.
  bool all_published(std::uint64_t ticks) {
    const std::scoped_lock lock(mutex_);
    return *std::min_element(published_.begin(), published_.end()) >= ticks;
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<std::uint64_t> published_ = {0};  // by arm
  std::uint64_t permitted_ = 0, done_ = 0;
};

/// Virtual time in which a tick waits until it is permitted, or the run is stopped. The same steps
/// give the same result, whatever the load of the machine. Never for a real arm, for which no tick
/// may wait.
class SteppedClock final : public driver::Clock {
 public:
  /// `stop` must outlive it.
  explicit SteppedClock(const std::atomic<bool>& stop) noexcept : stop_(stop) {}

  /// Any thread.
  std::int64_t now_ns() const noexcept override { return now_ns_.load(); }
  void sleep_until_ns(std::int64_t time_ns) noexcept override {
    constexpr std::chrono::milliseconds kLook(100);
    while (!stop_.load() && !steps_.wait_for_permit(kLook)) {
    }
    if (time_ns > now_ns_.load()) now_ns_.store(time_ns);
  }
  /// Returns the object that permits the ticks.
  RosSteps& steps() noexcept { return steps_; }

 private:
  const std::atomic<bool>& stop_;
  std::atomic<std::int64_t> now_ns_{0};
  RosSteps steps_;
};

}  // namespace thimble::ros2
