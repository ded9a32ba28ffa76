#include "track/curved_depth.h"

#include <algorithm>

#include "mesh/depth_below_concave.h"
#include "mesh/surface_weights.h"

namespace thimble::render {

double height_above(const ContactMesh& mesh, const SmoothNormals& normals, std::int32_t triangle,
                    const Eigen::Vector3d& weights) noexcept {
  const Eigen::Vector3d q = point_at(mesh, triangle, weights);
  const auto& n = normals.corners(triangle);
  double sum = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    sum += weights[static_cast<Eigen::Index>(k)] * (mesh.position(triangle, k) - q).dot(n[k]);
  }
  return sum / 2;
}

double CurvedDepth::depth(const ContactMesh& mesh, const SmoothNormals& normals,
                          std::int32_t triangle, const Eigen::Vector3d& weights,
                          double below_mesh) const noexcept {
  const double height = height_above(mesh, normals, triangle, weights);
  if (height < 0) return depth_below_concave(below_mesh, -height);
  const double corrected = below_mesh + std::min(height, below_mesh);
  // Written so that NaN means no depth.
  return corrected > 0 ? corrected : 0;
}

Eigen::Vector3d CurvedDepth::fall(const ContactMesh& mesh, const SmoothNormals& normals,
                                  const TrianglePlace& closest, double below_mesh,
                                  const Eigen::Vector3d& fall_of_mesh_W) const noexcept {
  const std::int32_t triangle = closest.triangle;
  const double height = height_above(mesh, normals, triangle, closest.weights);
  const Eigen::Vector3d rising = height_slope(
      {mesh.position(triangle, 0), mesh.position(triangle, 1), mesh.position(triangle, 2)},
      normals.corners(triangle), closest);
  if (height < 0) {
    const ConcaveDepthChange change = change_below_concave(below_mesh, -height);
    return change.per_depth * fall_of_mesh_W + change.per_gap * rising;
  }
  if (height < below_mesh) return fall_of_mesh_W - rising;
  return 2 * fall_of_mesh_W;
}

}  // namespace thimble::render
