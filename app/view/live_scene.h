#pragma once

#include <cstdint>

#include "share/shared_reader.h"
#include "view/drawn_scene.h"

namespace thimble::view {

/// Converts the shared data of a run to a moment to draw.
class LiveScene {
 public:
  /// Keeps the reader, which must outlive this. Real-time: never from the servo thread.
  explicit LiveScene(const session::SharedReader& reader);

  /// Returns the constant part of the scene.
  const DrawnScene& scene() const { return scene_; }

  /// Updates a moment to the newest state; data that the run has not shared stays unchanged.
  /// Returns whether there was a tick at all.
  bool update(DrawnMoment& moment);

 private:
  void update_shapes(DrawnMoment& moment);

  const session::SharedReader& reader_;
  DrawnScene scene_;
  std::uint64_t shape_moves_ = 0;
};

}  // namespace thimble::view
