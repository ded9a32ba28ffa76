#include "compat/server/lockstep_clock.h"

#include "compat/core/shared_wait.h"

namespace thimble::compat {

LockstepClock::LockstepClock(ArmChannel& channel) noexcept : channel_(channel) {
  channel_.permitted.store(channel_.ticks.load() + 1);
  channel_.paced.store(1);
}

LockstepClock::~LockstepClock() {
  channel_.paced.store(0);
}

void LockstepClock::sleep_until_ns(std::int64_t time_ns) noexcept {
  constexpr std::int64_t kLook_ns = 100'000'000;
  while (!released_.load()) {
    const std::uint32_t permitted = channel_.permitted.load();
    // Comparison with wrap-around: the permitted number is less than half the range ahead.
    if (static_cast<std::int32_t>(permitted - channel_.ticks.load()) > 0) break;
    wait_while(channel_.permitted, permitted, kLook_ns);
  }
  if (time_ns > now_ns_) now_ns_ = time_ns;
}

void LockstepClock::release() noexcept {
  released_.store(true);
  wake_all(channel_.permitted);
}

}  // namespace thimble::compat
