#pragma once

#include <cstddef>
#include <span>

#include "scene_poses.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/scene_touch.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Poses of the moving objects of a scene after the last tick.
class PoseRecord final : public TickObserver {
 public:
  /// Records the objects of `touch` listed in `moving`, at most ScenePoses::kMax. Both must
  /// outlive it. Real-time: never from the servo thread.
  PoseRecord(const render::SceneTouch& touch, std::span<const std::size_t> moving) noexcept
      : touch_(touch), moving_(moving) {}

  /// Receives one tick. Real-time: safe.
  void take(const driver::TickRecord& record) noexcept override {
    poses_.tick = record.tick;
    poses_.count = static_cast<std::uint32_t>(moving_.size());
    for (std::size_t i = 0; i < moving_.size(); ++i) {
      poses_.object[i] = static_cast<std::int32_t>(moving_[i]);
      poses_.pose[i] = touch_.object(moving_[i]).pose();
    }
  }

  /// Returns the poses. Call on the servo's thread, or after the run.
  const ScenePoses& now() const noexcept { return poses_; }

 private:
  const render::SceneTouch& touch_;
  std::span<const std::size_t> moving_;
  ScenePoses poses_;
};

}  // namespace thimble::session
