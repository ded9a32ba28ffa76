#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/body_pose.h"
#include "thimble/render/scene_touch.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Poses of the moving objects of a run, at a rate sufficient for an animation. All memory is
/// allocated and touched by the constructor.
class THIMBLE_EXPORT BodyTrace final : public session::TickObserver {
 public:
  /// Smallest time between two frames, ns: 60 a second.
  static constexpr std::int64_t kStep_ns = 16'000'000;
  /// Number of frames for a run of unknown duration: 5 minutes. [chosen]
  static constexpr std::size_t kFramesOfEndless = 18'750;

  /// Traces the objects of `touch` listed in `moving`; both must outlive it. `duration_ns` is that
  /// of the run; 0: unknown. Real-time: never from the servo thread.
  BodyTrace(const render::SceneTouch& touch, std::span<const std::size_t> moving,
            std::int64_t duration_ns);

  /// Stores the poses after a tick if a frame is due. When memory is full, every other frame is
  /// dropped, and later frames are taken half as often. Real-time: safe; in the tick without room
  /// it moves its memory once, some 100 us for a long run.
  void take(const driver::TickRecord& tick) noexcept override;

  /// Returns the traced objects.
  std::span<const std::size_t> moving() const noexcept { return moving_; }
  /// Returns the times of the frames, ns on the loop's clock.
  std::span<const std::int64_t> times_ns() const noexcept { return {times_ns_.data(), frames_}; }
  /// Returns the poses, `moving().size()` for each frame.
  std::span<const render::BodyPose> poses() const noexcept {
    return {poses_.data(), frames_ * moving_.size()};
  }

 private:
  void halve() noexcept;

  const render::SceneTouch& touch_;
  std::span<const std::size_t> moving_;
  std::vector<std::int64_t> times_ns_;
  std::vector<render::BodyPose> poses_;
  std::size_t frames_ = 0;
  std::int64_t step_ns_ = kStep_ns;
  std::int64_t next_ns_ = INT64_MIN;
};

}  // namespace thimble::session
