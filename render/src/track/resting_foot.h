#pragma once

#include "mesh/contact_mesh.h"
#include "mesh/surface_place.h"
#include "thimble/render/surface_foot.h"

namespace thimble::render {

/// Returns the foot of a tip that is held at the proxy, on a place of the surface, and how it moves
/// with the tip: over a face, along an edge, not at all in a corner (surface_foot.h). Real-time:
/// safe.
inline SurfaceFoot resting_foot(const ContactMesh& mesh, const SurfacePlace& place,
                                const ContactState& state) noexcept {
  SurfaceFoot foot = flat_foot(state);
  if (place.on == SurfacePlace::On::kCorner) foot.J_MT.setZero();
  if (place.on == SurfacePlace::On::kEdge) {
    const std::size_t k = place.k;
    const Eigen::Vector3d along =
        (mesh.position(place.triangle, (k + 1) % 3) - mesh.position(place.triangle, k))
            .stableNormalized();
    foot.J_MT = along * along.transpose();
  }
  return foot;
}

}  // namespace thimble::render
