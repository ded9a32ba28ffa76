#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <thread>

#include "thimble/driver/clock.h"

namespace thimble::support {

/// Time that passes only while the loop sleeps, `pace` times as long in real time. A busy machine
/// delays no tick, and other threads still get their turn. Any thread may read it; one thread
/// sleeps by it.
class PatientClock final : public driver::Clock {
 public:
  explicit PatientClock(double pace = 1) noexcept : pace_(pace) {}

  std::int64_t now_ns() const noexcept override { return now_ns_.load(); }
  void sleep_until_ns(std::int64_t time_ns) noexcept override {
    const std::int64_t now_ns = now_ns_.load();
    if (time_ns <= now_ns) return;
    std::this_thread::sleep_for(std::chrono::nanoseconds(
        static_cast<std::int64_t>(pace_ * static_cast<double>(time_ns - now_ns))));
    now_ns_.store(time_ns);
  }

 private:
  double pace_;
  std::atomic<std::int64_t> now_ns_{0};
};

}  // namespace thimble::support
