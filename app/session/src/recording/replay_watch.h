#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/session/recording.h"

namespace thimble::session {

/// Observer of a replay. Real-time: never from the servo thread.
class ReplayWatch {
 public:
  virtual ~ReplayWatch() = default;
  /// Receives the scene before the first tick; `objects` may be kept after the last one.
  virtual void begin(const scene::Scene& scene,
                     std::shared_ptr<const scene::SceneObjects> objects) = 0;
  /// Receives one tick of the scene's first arm, after the bodies of the scene have moved.
  virtual void take(const driver::TickRecord& tick) = 0;
};

/// Does the same as session::replay_together and notifies `watch`.
THIMBLE_EXPORT driver::Result<std::vector<Replay>> replay_together(
    std::span<const Recording> recordings, const std::string& scene, ReplayWatch* watch);

}  // namespace thimble::session
