#pragma once

#include <cstdint>

#include "drawn_dent.h"
#include "thimble/driver/tick_record.h"
#include "thimble/render/body_patch.h"
#include "thimble/render/scene_touch.h"
#include "thimble/session/tick_observer.h"

namespace thimble::session {

/// What is drawn of a scene's dents: the newest patch for whoever shows the run, and the one of the
/// deepest touch for its report.
class DentRecord final : public TickObserver {
 public:
  /// Lets a patch be drawn about 60 times a second of loops with this period (ns): that is as fast
  /// as pictures change. `touch` must outlive it. Real-time: never from the servo thread.
  DentRecord(render::SceneTouch& touch, std::int64_t period_ns);

  /// Returns every how many ticks a loop with this period (ns) has its dents drawn.
  static std::uint64_t ticks_between(std::int64_t period_ns) noexcept;

  /// Draws if it is time. Real-time: safe; some 10 us in one tick of 16.
  void take(const driver::TickRecord& tick) noexcept override;

  /// Returns what was drawn last.
  const DrawnDent& drawn() const noexcept { return drawn_; }
  /// Returns the patch of the deepest touch; no triangles if nothing was dented. After the run.
  const render::BodyPatch& deepest() const noexcept { return deepest_; }

 private:
  render::SceneTouch& touch_;
  std::uint64_t every_;
  double depth_ = 0;
  DrawnDent drawn_;
  render::BodyPatch deepest_{};
};

}  // namespace thimble::session
