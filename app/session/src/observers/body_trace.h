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

/// Where the objects of a run that move have been, often enough for a film of it. All memory is
/// there and touched when it is made.
class THIMBLE_EXPORT BodyTrace final : public session::TickObserver {
 public:
  /// Between two pictures, at least, ns: a screen's 60 a second.
  static constexpr std::int64_t kStep_ns = 16'000'000;
  /// Pictures of a run whose end nobody knows: 5 minutes. [chosen]
  static constexpr std::size_t kFramesOfEndless = 18'750;

  /// Looks at the objects of `touch` that `moving` lists; both must outlive it. `duration_ns` is
  /// that of the run; 0: unknown. Real-time: never from the servo thread.
  BodyTrace(const render::SceneTouch& touch, std::span<const std::size_t> moving,
            std::int64_t duration_ns);

  /// Keeps the poses after a tick if it is time for a picture. Once there is no room for more, only
  /// every other picture stays, and from then on they are taken half as often.
  /// Real-time: safe; in the tick without room it moves its memory once, some 100 us of a long run.
  void take(const driver::TickRecord& tick) noexcept override;

  /// Returns the objects that it looks at.
  std::span<const std::size_t> moving() const noexcept { return moving_; }
  /// Returns when the pictures were taken, ns on the loop's clock.
  std::span<const std::int64_t> times_ns() const noexcept { return {times_ns_.data(), frames_}; }
  /// Returns the poses: of each picture as many as `moving` has.
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
