#include "thimble/driver/clock.h"

#include <cerrno>
#include <ctime>

namespace thimble::driver {
namespace {

std::int64_t monotonic_ns() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

}  // namespace

WallClock::WallClock(std::int64_t spin_ns) noexcept
    : spin_ns_(spin_ns), start_ns_(monotonic_ns()) {}

std::int64_t WallClock::now_ns() const noexcept {
  return monotonic_ns() - start_ns_;
}

void WallClock::sleep_until_ns(std::int64_t time_ns) noexcept {
  const std::int64_t sleep_to_ns = start_ns_ + time_ns - spin_ns_;
  if (sleep_to_ns > monotonic_ns()) {
    const timespec until{.tv_sec = static_cast<time_t>(sleep_to_ns / 1'000'000'000),
                         .tv_nsec = static_cast<long>(sleep_to_ns % 1'000'000'000)};
    while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
  }
  while (now_ns() < time_ns) {
  }
}

}  // namespace thimble::driver
