#include "thimble/driver/clock.h"

#include <cerrno>
#include <ctime>

namespace thimble::driver {
namespace {

std::int64_t time_of(clockid_t id) noexcept {
  timespec now{};
  clock_gettime(id, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1'000'000'000 + now.tv_nsec;
}

/// Returns the clock of the loop: one that the kernel can also sleep by.
clockid_t clock_of_loop() noexcept {
  const timespec past{};
  timespec now{};
  const bool works = clock_gettime(CLOCK_BOOTTIME, &now) == 0 &&
                     clock_nanosleep(CLOCK_BOOTTIME, TIMER_ABSTIME, &past, nullptr) == 0;
  return works ? CLOCK_BOOTTIME : CLOCK_MONOTONIC;
}

/// Returns the time for which the computer has been suspended since boot, ns. The two clocks are
/// not read at the same instant, so CLOCK_MONOTONIC is taken as the mean of its readings before and
/// after.
std::int64_t asleep_since_boot_ns() noexcept {
  const std::int64_t before = time_of(CLOCK_MONOTONIC);
  const std::int64_t boot = time_of(CLOCK_BOOTTIME);
  const std::int64_t after = time_of(CLOCK_MONOTONIC);
  return boot - before / 2 - after / 2;
}

}  // namespace

WallClock::WallClock(std::int64_t spin_ns) noexcept
    : id_(clock_of_loop()),
      spin_ns_(spin_ns),
      start_ns_(time_of(id_)),
      ahead_ns_(asleep_since_boot_ns()) {}

std::int64_t WallClock::now_ns() const noexcept {
  return time_of(id_) - start_ns_;
}

std::int64_t WallClock::asleep_ns() const noexcept {
  return id_ == CLOCK_BOOTTIME ? asleep_since_boot_ns() - ahead_ns_ : 0;
}

void WallClock::sleep_until_ns(std::int64_t time_ns) noexcept {
  const std::int64_t sleep_to_ns = start_ns_ + time_ns - spin_ns_;
  if (sleep_to_ns > time_of(id_)) {
    const timespec until{.tv_sec = static_cast<time_t>(sleep_to_ns / 1'000'000'000),
                         .tv_nsec = static_cast<long>(sleep_to_ns % 1'000'000'000)};
    while (clock_nanosleep(id_, TIMER_ABSTIME, &until, nullptr) == EINTR) {
    }
  }
  while (now_ns() < time_ns) {
  }
}

}  // namespace thimble::driver
