#include "speed_clock.h"

#include <algorithm>
#include <cerrno>
#include <ctime>

namespace thimble::session {

double paced_due(double due_ns, double world_ns, double virtual_ns, double speed) noexcept {
  const double earliest_due_ns = world_ns - static_cast<double>(SpeedClock::kCatchUpMax_ns);
  return std::max(due_ns + virtual_ns / speed, earliest_due_ns);
}

void SpeedClock::sleep_until_ns(std::int64_t time_ns) noexcept {
  if (time_ns <= now_ns_) return;
  timespec world{};
  clock_gettime(CLOCK_MONOTONIC, &world);
  const double world_ns =
      static_cast<double>(world.tv_sec) * 1e9 + static_cast<double>(world.tv_nsec);
  if (now_ns_ == 0) due_ns_ = world_ns;
  due_ns_ = paced_due(due_ns_, world_ns, static_cast<double>(time_ns - now_ns_),
                      speed_.load(std::memory_order_relaxed));
  now_ns_ = time_ns;
  if (due_ns_ <= world_ns) return;
  const auto until_ns = static_cast<std::int64_t>(due_ns_);
  const timespec until{.tv_sec = static_cast<time_t>(until_ns / 1'000'000'000),
                       .tv_nsec = static_cast<long>(until_ns % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
  }
}

}  // namespace thimble::session
