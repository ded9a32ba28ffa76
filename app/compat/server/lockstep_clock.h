#pragma once

#include <atomic>
#include <cstdint>

#include "compat/core/arm_channel.h"
#include "thimble/driver/clock.h"

namespace thimble::compat {

/// Virtual time that waits for a program. A tick begins when the program waits for one, so that
/// every tick has the force requested after the tick before. The same program gives the same
/// result, whatever the load of the machine. Never for a real arm, for which no tick may wait.
class LockstepClock final : public driver::Clock {
 public:
  /// Takes the channel of an arm that is not running, and permits its first tick. The channel must
  /// outlive it.
  explicit LockstepClock(ArmChannel& channel) noexcept;
  /// Ticks of the arm's next clock need not wait.
  ~LockstepClock() override;

  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void sleep_until_ns(std::int64_t time_ns) noexcept override;

  /// Lets the loop continue without the program, to its end. Any thread.
  void release() noexcept;

 private:
  ArmChannel& channel_;
  std::int64_t now_ns_ = 0;
  std::atomic<bool> released_{false};
};

}  // namespace thimble::compat
