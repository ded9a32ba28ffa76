#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "mesh/contact_mesh.h"
#include "mesh/smooth_normals.h"
#include "mesh/triangle_foot.h"

namespace thimble::render {

/// Finds how far the smooth surface that the corners' normals tell of stands above a place on a
/// triangle (surface_weights.h), m along the normal; negative where it is hollow:
/// 1/2 sum of w_k (x_k - q) . n_k with q the place. Exact to second order; L^2 / 8R in the middle
/// of an edge of length L on a sphere of radius R. 0 on flat ground, and continuous over edges that
/// are no creases. Real-time: safe.
double height_above(const ContactMesh& mesh, const SmoothNormals& normals, std::int32_t triangle,
                    const Eigen::Vector3d& weights) noexcept;

/// Leaves the depth below the triangles as it is. A `Depth` stage of Blended.
struct MeshDepth {
  double depth(const ContactMesh&, const SmoothNormals&, std::int32_t, const Eigen::Vector3d&,
               double below_mesh) const noexcept {
    return below_mesh;
  }
  /// Returns `fall_of_mesh_W` as it is.
  Eigen::Vector3d fall(const ContactMesh&, const SmoothNormals&, const TriangleFoot&, double,
                       const Eigen::Vector3d& fall_of_mesh_W) const noexcept {
    return fall_of_mesh_W;
  }
};

/// Turns the depth below the triangles into the depth below the smooth surface they stand for
/// [PHYSICS 3]. A `Depth` stage of Blended.
///
/// With the smooth surface at height h above the place and the tip at depth d below the mesh it is
/// d + min(h, d), at least 0. Contact still begins where the tip enters the mesh, so where h > 0 a
/// plain d + h would begin with a jump of the force; this rises twice as steeply for the first h
/// and is exact from there on. Whoever has a mesh so coarse that h is felt should halve the
/// stiffness that is just stable, or take a finer mesh. Where h < 0, in a hollow, the force too
/// begins where the tip enters the mesh, softly: the depth is d^2 / 4|h| up to d = 2|h|, where it
/// and its slope are those of d + h (`depth_below_hollow`).
struct CurvedDepth {
  double depth(const ContactMesh& mesh, const SmoothNormals& normals, std::int32_t triangle,
               const Eigen::Vector3d& weights, double below_mesh) const noexcept;
  /// Returns minus the gradient of `depth` in the tip's place (W), where the tip belongs to `foot`
  /// and that of `below_mesh` is `fall_of_mesh_W`.
  Eigen::Vector3d fall(const ContactMesh& mesh, const SmoothNormals& normals,
                       const TriangleFoot& foot, double below_mesh,
                       const Eigen::Vector3d& fall_of_mesh_W) const noexcept;
};

}  // namespace thimble::render
