#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "thimble/driver/tick_record.h"
#include "view/drawn_scene.h"

namespace thimble::view {

/// Keeps the path of the tip of the last seconds, with the force on the hand: on the surface during
/// contact.
/// Real-time: never from the servo thread.
class TipTrail {
 public:
  static constexpr double kSeconds = 4;  ///< Kept duration. Chosen: a stroke in both directions.

  /// Takes one tick. A tick older than the last one means a new run and clears the path. A tip at
  /// rest adds nothing, nor does one that is not finite.
  void add(const driver::TickRecord& tick);
  void clear() { kept_.clear(); }
  /// Writes the path, oldest first, to `trail`.
  void copy_to(std::vector<TrailPoint>& trail) const;

 private:
  struct Kept {
    std::int64_t time_ns;
    TrailPoint point;
  };
  std::deque<Kept> kept_;
};

}  // namespace thimble::view
