#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "mesh/triangle_place.h"

namespace thimble::render {

/// Returns the height of the smooth surface, defined by the corner normals, above a place q on a
/// triangle (surface_weights.h), m along the normal; negative where it is concave: 1/2 sum of w_k
/// (x_k - q) . n_k. Exact to second order; L^2 / 8R in the middle of an edge of length L on a
/// sphere of radius R. 0 on flat ground, and continuous over edges that are not creases. Real-time:
/// safe.
double height_above(const ContactMesh& mesh, const SmoothNormals& normals, std::int32_t triangle,
                    const Eigen::Vector3d& weights) noexcept;

/// Keeps the depth below the triangles. A `Depth` stage of Blended.
struct MeshDepth {
  double depth(const ContactMesh&, const SmoothNormals&, std::int32_t, const Eigen::Vector3d&,
               double below_mesh) const noexcept {
    return below_mesh;
  }
  /// Returns `fall_of_mesh_W` unchanged.
  Eigen::Vector3d fall(const ContactMesh&, const SmoothNormals&, const TrianglePlace&, double,
                       const Eigen::Vector3d& fall_of_mesh_W) const noexcept {
    return fall_of_mesh_W;
  }
};

/// Converts the depth below the triangles to the depth below the smooth surface that they
/// approximate [PHYSICS 3]. A `Depth` stage of Blended.
///
/// Let the smooth surface be at height h above the place, and the tip at depth d below the mesh.
/// The result is d + min(h, d), at least 0. Contact still begins where the tip enters the mesh, so
/// where h > 0 a plain d + h would begin with a jump of the force. This one rises twice as steeply
/// for the first h and is exact from there on. If a mesh is so coarse that h is felt, halve the
/// stiffness that is just stable, or use a finer mesh. Where h < 0 (concave), the force also begins
/// softly where the tip enters the mesh. The depth is d^2 / 4|h| up to d = 2|h|, where it and its
/// slope are those of d + h (`depth_below_concave`).
struct CurvedDepth {
  double depth(const ContactMesh& mesh, const SmoothNormals& normals, std::int32_t triangle,
               const Eigen::Vector3d& weights, double below_mesh) const noexcept;
  /// Returns minus the gradient of `depth` by the tip's position (W). `foot` is the place of the
  /// tip, and `fall_of_mesh_W` minus the gradient of `below_mesh`.
  Eigen::Vector3d fall(const ContactMesh& mesh, const SmoothNormals& normals,
                       const TrianglePlace& closest, double below_mesh,
                       const Eigen::Vector3d& fall_of_mesh_W) const noexcept;
};

}  // namespace thimble::render
