#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "view/drawn_scene.h"

namespace thimble::view {

/// Keeps where the tip was in the last seconds, with the force on the hand there: on the surface
/// while it touches one.
/// Real-time: never from the servo thread.
class TipTrail {
 public:
  static constexpr double kSeconds = 4;  ///< What is kept. Chosen: a stroke there and back.

  /// Takes one tick; one that is older than the last begins anew. A tip that rests adds nothing,
  /// one that is not finite neither.
  void add(const driver::TickRecord& tick);
  void clear() { kept_.clear(); }
  /// Gives the path, oldest first, into `trail`.
  void give(std::vector<TrailPoint>& trail) const;

 private:
  struct Kept {
    std::int64_t time_ns;
    TrailPoint point;
  };
  std::deque<Kept> kept_;
};

}  // namespace thimble::view
