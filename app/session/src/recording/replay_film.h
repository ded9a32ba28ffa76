#pragma once

#include <cstddef>
#include <memory>

#include "observers/body_trace.h"
#include "observers/dent_record.h"
#include "observers/dent_trace.h"
#include "recording/replay_watch.h"
#include "thimble/driver/export.h"

namespace thimble::session {

/// Keeps what a replay must be shown with, and what its ticks do not tell: where the objects moved
/// and how they were dented. Real-time: never from the servo thread.
class THIMBLE_EXPORT ReplayFilm : public ReplayWatch {
 public:
  void begin(const scene::Scene& scene,
             std::shared_ptr<const scene::SceneObjects> objects) override;
  void take(const driver::TickRecord& tick) override;

  /// Returns the scene that is touched. Precondition of both: the replay has begun.
  const scene::Scene& scene() const { return scene_; }
  /// Returns its objects, as the last tick left them.
  const scene::SceneObjects& objects() const { return *objects_; }
  /// Returns which of the scene's arms a recording is of.
  std::size_t arm_of(const RecordingInfo& info) const;
  /// Returns where the objects were that move; null if none does.
  const BodyTrace* bodies() const { return bodies_.get(); }
  /// Returns how objects were dented; null if none can be.
  const DentTrace* dents() const { return dents_.get(); }

 private:
  scene::Scene scene_;
  std::shared_ptr<const scene::SceneObjects> objects_;
  std::unique_ptr<BodyTrace> bodies_;
  std::unique_ptr<DentRecord> dent_now_;  // null if nothing dents, as the next
  std::unique_ptr<DentTrace> dents_;
};

}  // namespace thimble::session
