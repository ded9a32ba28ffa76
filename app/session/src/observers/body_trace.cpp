#include "observers/body_trace.h"

#include <algorithm>

namespace thimble::session {

BodyTrace::BodyTrace(const render::SceneTouch& touch, std::span<const std::size_t> moving,
                     std::int64_t duration_ns)
    : touch_(touch), moving_(moving) {
  const auto expected = static_cast<std::size_t>(duration_ns / kStep_ns) + 2;
  const std::size_t room =
      duration_ns > 0 ? std::min(expected, kFramesOfEndless) : kFramesOfEndless;
  times_ns_.resize(room);
  poses_.resize(room * moving.size());
}

void BodyTrace::take(const driver::TickRecord& tick) noexcept {
  if (tick.time_ns < next_ns_) return;
  if (frames_ == times_ns_.size()) halve();
  times_ns_[frames_] = tick.time_ns;
  for (std::size_t i = 0; i < moving_.size(); ++i) {
    poses_[frames_ * moving_.size() + i] = touch_.object(moving_[i]).pose();
  }
  ++frames_;
  next_ns_ = tick.time_ns + step_ns_;
}

void BodyTrace::halve() noexcept {
  const std::size_t count = moving_.size();
  std::size_t stays = 0;
  for (std::size_t i = 0; i < frames_; i += 2, ++stays) {
    times_ns_[stays] = times_ns_[i];
    for (std::size_t k = 0; k < count; ++k) poses_[stays * count + k] = poses_[i * count + k];
  }
  frames_ = stays;
  step_ns_ *= 2;
}

}  // namespace thimble::session
