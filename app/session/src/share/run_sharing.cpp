#include "share/run_sharing.h"

namespace thimble::session {

void RunSharing::take(const driver::TickRecord& record) noexcept {
  shared_.store_tick(record);
  if (moving_.dent != nullptr && moving_.dent->drawings != drawings_) {
    drawings_ = moving_.dent->drawings;
    shared_.store_patch(moving_.dent->patch);
  }
  if (moving_.poses != nullptr) shared_.store_poses(*moving_.poses);
  for (const Shaped& one : moving_.shaped) {
    for (const render::VertexMove& move : one.shape->moves()) {
      shared_.store_vertex(one.first + static_cast<std::size_t>(move.vertex), move.p_W);
    }
  }
}

}  // namespace thimble::session
