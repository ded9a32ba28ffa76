#pragma once

#include <cstdint>

#include "share/shared_reader.h"
#include "view/drawn_scene.h"

namespace thimble::view {

/// Turns what a run shares into what is drawn.
class LiveScene {
 public:
  /// Keeps the reader, which must outlive this. Real-time: never from the servo thread.
  explicit LiveScene(const session::SharedReader& reader);

  /// Returns what does not change.
  const DrawnScene& scene() const { return scene_; }

  /// Brings a moment to what is newest; what the run has not told stays as it is. Tells whether
  /// there was a tick at all.
  bool update(DrawnMoment& moment);

 private:
  void update_shapes(DrawnMoment& moment);

  const session::SharedReader& reader_;
  DrawnScene scene_;
  std::uint64_t shape_moves_ = 0;
};

}  // namespace thimble::view
