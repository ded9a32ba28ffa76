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

/// Looks on while recorded hands touch a scene again. Real-time: never from the servo thread.
class ReplayWatch {
 public:
  virtual ~ReplayWatch() = default;
  /// Takes the scene before the first tick; `objects` may be kept after the last one.
  virtual void begin(const scene::Scene& scene,
                     std::shared_ptr<const scene::SceneObjects> objects) = 0;
  /// Takes one tick of the scene's first arm, once the bodies of the scene have moved.
  virtual void take(const driver::TickRecord& tick) = 0;
};

/// Does what session::replay_together does while `watch` looks on.
THIMBLE_EXPORT driver::Result<std::vector<Replay>> replay_together(
    std::span<const Recording> recordings, const std::string& scene, ReplayWatch* watch);

}  // namespace thimble::session
