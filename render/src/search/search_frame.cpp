#include "search/search_frame.h"

#include <limits>

namespace thimble::render {

SearchFrame frame_of(const PackedSurface& surface) noexcept {
  return {surface.origin(), surface.step(), kLatticeHalf / (surface.step() * kLatticeHalf)};
}

SearchFrame frame_of(const ContactMesh& mesh) noexcept {
  const double half =
      (mesh.box_max() - mesh.origin()).cwiseMax(mesh.origin() - mesh.box_min()).maxCoeff();
  return {mesh.origin(), half / kLatticeHalf, kLatticeHalf / half};
}

}  // namespace thimble::render
