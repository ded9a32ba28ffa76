#pragma once

#include <cstdint>

#include "drawn_dent.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/body_patch.h"
#include "thimble/render/scene_touch.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// Drawn dents of a scene: the newest patch for viewers, and the patch of the deepest touch for the
/// report.
class DentRecord final : public TickObserver {
 public:
  /// Draws a patch about 60 times a second, the rate of pictures, for loops with this period (ns).
  /// `touch` must outlive it. Real-time: never from the servo thread.
  DentRecord(render::SceneTouch& touch, std::int64_t period_ns);

  /// Returns the number of ticks between two drawings for a loop with this period (ns).
  static std::uint64_t ticks_between(std::int64_t period_ns) noexcept;

  /// Draws if a drawing is due. Real-time: safe; some 10 us in one tick of 16.
  void take(const driver::TickRecord& tick) noexcept override;

  /// Returns the last drawing.
  const DrawnDent& drawn() const noexcept { return drawn_; }
  /// Returns the patch of the deepest touch; no triangles if nothing was dented. Call after the
  /// run.
  const render::BodyPatch& deepest() const noexcept { return deepest_; }

 private:
  render::SceneTouch& touch_;
  std::uint64_t every_;
  double depth_ = 0;
  DrawnDent drawn_;
  render::BodyPatch deepest_{};
};

}  // namespace thimble::session
