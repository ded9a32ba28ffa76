#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "mesh/surface_place.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// What holds a tip in a hollow: the nearest point of the surface around, on a face, on an edge
/// where two faces hold it, or at a corner where three and more do (hollows.md). W, m.
struct HollowHold {
  bool holds = false;             ///< False if the tip is not below the surface there.
  SurfacePlace place;             ///< What of the surface it is.
  double depth = 0;               ///< Distance of the tip from it.
  Eigen::Vector3d n_W{0, 0, 0};   ///< Unit direction from the tip to it; a face's normal on a face.
  Eigen::Vector3d p_WH{0, 0, 0};  ///< The point.
  std::uint16_t hops = 0;         ///< Triangles gone on to.
};

/// Returns what holds the tip `p_WT` (W, m) where it is beside `triangle`, over a hollow edge of
/// it: slides from there over the surface to the point nearest to the tip among all around it, as a
/// god-object does (surface_descent.h). Continuous in the tip as long as the surface around is
/// hollow. Real-time: safe; two triangles in most cases.
HollowHold hold_in_hollow(const ContactMesh& mesh, std::int32_t triangle,
                          const Eigen::Vector3d& p_WT) noexcept;

/// Returns whether a place lies on a crease in a hollow, or at a corner where there is one: there
/// what holds the tip is felt as it is, and no shading goes across. Real-time: safe; at worst one
/// fan.
bool on_hollow_crease(const ContactMesh& mesh, const SmoothNormals& normals,
                      const SurfacePlace& place) noexcept;

/// Returns the foot of a tip that is held at the proxy, on a place of the surface, and how it moves
/// with the tip: over a face, along an edge, not at all in a corner (surface_response.h).
/// Real-time: safe.
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
