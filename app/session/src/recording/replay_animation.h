#pragma once

#include <cstddef>
#include <memory>

#include "observers/body_trace.h"
#include "observers/dent_record.h"
#include "observers/dent_trace.h"
#include "recording/replay_watch.h"
#include "thimble/driver/export.h"

namespace thimble::session {

/// Stores the data for showing a replay that its ticks do not contain: poses and dents of the
/// objects. Real-time: never from the servo thread.
class THIMBLE_EXPORT ReplayAnimation : public ReplayWatch {
 public:
  void begin(const scene::Scene& scene,
             std::shared_ptr<const scene::SceneObjects> objects) override;
  void take(const driver::TickRecord& tick) override;

  /// Returns the scene. Precondition, also of `objects`: the replay has started.
  const scene::Scene& scene() const { return scene_; }
  /// Returns the objects of the scene after the last tick.
  const scene::SceneObjects& objects() const { return *objects_; }
  /// Returns the number of the scene's arm to which a recording belongs.
  std::size_t arm_of(const RecordingInfo& info) const;
  /// Returns the poses of moving objects; null if none moves.
  const BodyTrace* bodies() const { return bodies_.get(); }
  /// Returns the dents of objects; null if none can dent.
  const DentTrace* dents() const { return dents_.get(); }

 private:
  scene::Scene scene_;
  std::shared_ptr<const scene::SceneObjects> objects_;
  std::unique_ptr<BodyTrace> bodies_;
  std::unique_ptr<DentRecord> dent_now_;  // Null if nothing dents; also dents_.
  std::unique_ptr<DentTrace> dents_;
};

}  // namespace thimble::session
