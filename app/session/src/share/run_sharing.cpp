#include "share/run_sharing.h"

namespace thimble::session {

void RunSharing::take(const driver::TickRecord& record) noexcept {
  shared_.store_tick(record);
  if (moving_.dent != nullptr && moving_.dent->drawings != drawings_) {
    drawings_ = moving_.dent->drawings;
    shared_.store_patch(moving_.dent->patch);
  }
  if (moving_.poses != nullptr) shared_.store_poses(*moving_.poses);
  for (Shaped& one : moving_.shaped) {
    for (const render::VertexMove& move : one.shape->moves()) {
      shared_.store_vertex(one.first + static_cast<std::size_t>(move.vertex), move.p_W);
    }
    for (const render::EdgeSplit& split : one.shape->splits()) {
      // A tick in which the scene is not computed repeats the splits of the last one.
      if (split.vertex != one.vertices) continue;
      const auto vertex = static_cast<std::size_t>(one.vertices++);
      shared_.store_vertex(one.first + vertex, one.shape->place(split.vertex));
      shared_.store_split(one.first_split++, split);
    }
  }
}

}  // namespace thimble::session
