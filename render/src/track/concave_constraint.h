#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "mesh/surface_place.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// The closest surface point that holds a tip in a groove or pit: on a face, on an edge of two
/// faces, or at a corner of three or more (grooves.md). W, m.
struct GrooveHold {
  bool holds = false;             ///< False if the tip is not below the surface there.
  SurfacePlace place;             ///< Face, edge or corner that holds the tip.
  double depth = 0;               ///< Distance of the tip from the point.
  Eigen::Vector3d n_W{0, 0, 0};   ///< Unit direction from tip to point; on a face, its normal.
  Eigen::Vector3d p_WH{0, 0, 0};  ///< The point.
  std::uint16_t hops = 0;         ///< Number of triangles crossed.
};

/// Returns what holds the tip `p_WT` (W, m) if it is next to `triangle`, over a concave edge of it.
/// Slides from there over the surface to the closest point nearby, as a god-object does
/// (surface_descent.h). Continuous in the tip as long as the surface nearby is concave. Real-time:
/// safe; two triangles in most cases.
GrooveHold hold_in_groove(const ContactMesh& mesh, std::int32_t triangle,
                          const Eigen::Vector3d& p_WT) noexcept;

/// Returns whether a place is on a concave crease, or at a corner with one. The contact is not
/// shaded there. Real-time: safe; at worst one fan.
bool on_concave_crease(const ContactMesh& mesh, const SmoothNormals& normals,
                       const SurfacePlace& place) noexcept;

/// Returns the surface point of a tip that is held at the proxy, and its derivative by the tip:
/// over a face, along an edge, zero in a corner (surface_response.h). Real-time: safe.
inline ClosestSurfacePoint resting_closest_point(const ContactMesh& mesh, const SurfacePlace& place,
                                                 const ContactState& state) noexcept {
  ClosestSurfacePoint closest = flat_closest_point(state);
  if (place.on == SurfacePlace::On::kCorner) closest.J_MT.setZero();
  if (place.on == SurfacePlace::On::kEdge) {
    const std::size_t k = place.k;
    const Eigen::Vector3d along =
        (mesh.position(place.triangle, (k + 1) % 3) - mesh.position(place.triangle, k))
            .stableNormalized();
    closest.J_MT = along * along.transpose();
  }
  return closest;
}

}  // namespace thimble::render
