#include "ros2/wrench_law.h"

#include <algorithm>

namespace thimble::ros2 {
namespace {

/// A writer interrupted during a write must not delay a tick.
constexpr int kAttempts = 4;

void count(std::atomic<std::uint64_t>& counter) noexcept {
  counter.store(counter.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
}

}  // namespace

WrenchLaw::WrenchLaw(const RosChannel& channel, driver::ForceLaw scene, const RosOptions& options,
                     const driver::GateLimits& limits) noexcept
    : channel_(channel),
      scene_(scene),
      limits_(limits),
      replace_(options.force == RosForce::kReplace),
      force_limit_(options.force_limit > 0 ? std::min(options.force_limit, limits.force_max)
                                           : limits.force_max),
      stale_ns_(options.stale_ns) {}

driver::ForceCommand WrenchLaw::operator()(const driver::DeviceState& state) noexcept {
  driver::ForceCommand command = scene_(state);
  take(state.time_ns);
  if (!stale_) {
    opened_ = opening_ > 0 ? std::min(1.0, opened_ + state.dt / opening_) : 1.0;
  }
  // Without the scene's force, its springs store no energy for the gate's balance.
  if (replace_) command = {};
  if (!stale_) {
    const Eigen::Vector3d f_W = opened_ * f_asked_W_;
    command.f_T_W += f_W;
    command.f_program_W += f_W;
  }
  return command;
}

void WrenchLaw::take(std::int64_t time_ns) noexcept {
  RosWrench newest;
  if (channel_.wrench.load(newest, kAttempts) && newest.number != taken_ &&
      !(time_ns - newest.time_ns > stale_ns_)) {
    if (stale_) {
      const bool long_ago = taken_ == 0 || time_ns - taken_ns_ > limits_.watchdog_ns;
      opening_ = long_ago ? limits_.soft_start : limits_.reopen;
      opened_ = 0;
      stale_ = false;
    }
    taken_ = newest.number;
    // A stamp before the start of the run or in the future belongs to another clock.
    if (newest.answers_ns > 0 && newest.answers_ns <= time_ns) {
      ages_.add(time_ns - newest.answers_ns);
    }
    taken_ns_ = std::min(time_ns, newest.time_ns);
    f_asked_W_ = Eigen::Map<const Eigen::Vector3d>(newest.f_W.data());
    // stableNorm, because the square of a huge force overflows.
    if (const double length = f_asked_W_.stableNorm(); length > force_limit_) {
      f_asked_W_ *= force_limit_ / length;
      count(cut_);
    }
  } else if (!stale_ && time_ns - taken_ns_ > stale_ns_) {
    stale_ = true;
    count(stalls_);
  }
}

}  // namespace thimble::ros2
