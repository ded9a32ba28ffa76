#include "faces/server/paced_clock.h"

#include "faces/core/shared_wait.h"

namespace thimble::faces {

PacedClock::PacedClock(ArmChannel& channel) noexcept : channel_(channel) {
  channel_.permitted.store(channel_.ticks.load() + 1);
  channel_.paced.store(1);
}

PacedClock::~PacedClock() {
  channel_.paced.store(0);
}

void PacedClock::sleep_until_ns(std::int64_t time_ns) noexcept {
  constexpr std::int64_t kLook_ns = 100'000'000;
  while (!released_.load()) {
    const std::uint32_t permitted = channel_.permitted.load();
    // Counted around: what is permitted is less than half the numbers ahead.
    if (static_cast<std::int32_t>(permitted - channel_.ticks.load()) > 0) break;
    wait_while(channel_.permitted, permitted, kLook_ns);
  }
  if (time_ns > now_ns_) now_ns_ = time_ns;
}

void PacedClock::release() noexcept {
  released_.store(true);
  wake_all(channel_.permitted);
}

}  // namespace thimble::faces
