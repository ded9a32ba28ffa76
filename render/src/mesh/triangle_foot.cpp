#include "mesh/triangle_foot.h"

#include <Eigen/Geometry>
#include <array>

namespace thimble::render {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TriangleFoot edge_plane_foot(const ContactMesh& mesh, std::int32_t triangle,
                             const Vector3d& p_WT) noexcept {
  TriangleFoot foot{.triangle = triangle, .weights = Vector3d::Constant(1.0 / 3)};
  const EdgePlaneSides sides = edge_plane_sides(mesh, triangle, p_WT);
  // As edge_plane_weights.
  if (!(sides.value.sum() > 0)) return foot;
  Vector3d value = sides.value;
  Matrix3d change = sides.change;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (value[k] >= 0) continue;
    value[k] = 0;
    change.row(k).setZero();
  }
  const double sum = value.sum();
  foot.weights = value / sum;
  foot.change = (change - foot.weights * change.colwise().sum()) / sum;
  return foot;
}

TriangleFoot offset_foot(const std::array<Vector3d, 3>& x, const std::array<Vector3d, 3>& n,
                         const Vector3d& weights, double depth) noexcept {
  TriangleFoot foot{.weights = weights};
  const Vector3d side_1 = x[1] - x[0] - depth * (n[1] - n[0]);
  const Vector3d side_2 = x[2] - x[0] - depth * (n[2] - n[0]);
  const Vector3d way_down = weights[0] * n[0] + weights[1] * n[1] + weights[2] * n[2];
  const double volume = side_1.cross(side_2).dot(way_down);
  // Turned over, or NaN.
  if (!(volume > 0)) return foot;
  foot.change.row(1) = side_2.cross(way_down).transpose() / volume;
  foot.change.row(2) = way_down.cross(side_1).transpose() / volume;
  foot.change.row(0) = -foot.change.row(1) - foot.change.row(2);
  foot.sink = -side_1.cross(side_2) / volume;
  return foot;
}

Vector3d offset_depth_slope(const std::array<Vector3d, 3>& n, const TriangleFoot& foot,
                            double depth) noexcept {
  const Vector3d& w = foot.weights;
  const Vector3d N = w[0] * n[0] + w[1] * n[1] + w[2] * n[2];
  const double size = N.norm();
  const Vector3d along = Vector3d(n[0].dot(N), n[1].dot(N), n[2].dot(N)) / size;
  return size * foot.sink + depth * (foot.change.transpose() * along);
}

Vector3d height_slope(const std::array<Vector3d, 3>& x, const std::array<Vector3d, 3>& n,
                      const TriangleFoot& foot) noexcept {
  const auto bulge = [&](std::size_t i, std::size_t j) { return (x[i] - x[j]).dot(n[i] - n[j]); };
  const double b01 = bulge(0, 1), b12 = bulge(1, 2), b20 = bulge(2, 0);
  const Vector3d& w = foot.weights;
  const Vector3d by_weight(w[1] * b01 + w[2] * b20, w[0] * b01 + w[2] * b12,
                           w[1] * b12 + w[0] * b20);
  return 0.5 * (foot.change.transpose() * by_weight);
}

TriangleFoot offset_foot(const ContactMesh& mesh, const SmoothNormals& normals,
                         std::int32_t triangle, const Vector3d& weights, double depth) noexcept {
  TriangleFoot foot = offset_foot(
      {mesh.position(triangle, 0), mesh.position(triangle, 1), mesh.position(triangle, 2)},
      normals.corners(triangle), weights, depth);
  foot.triangle = triangle;
  return foot;
}

FootPath path_of(const ContactMesh& mesh, const TriangleFoot& foot) noexcept {
  // Relative to a corner, as the rows of `change` sum to 0: far from the origin no digits are lost.
  const Vector3d& a = mesh.position(foot.triangle, 0);
  const Vector3d side_1 = mesh.position(foot.triangle, 1) - a;
  const Vector3d side_2 = mesh.position(foot.triangle, 2) - a;
  return {.p_W = a + foot.weights[1] * side_1 + foot.weights[2] * side_2,
          .J = side_1 * foot.change.row(1) + side_2 * foot.change.row(2)};
}

FootPath carried_back(const ContactMesh& mesh, std::int32_t triangle,
                      const std::array<Vector3d, 3>& first, const FootPath& now) noexcept {
  const Vector3d& a = mesh.position(triangle, 0);
  const Vector3d side_1 = mesh.position(triangle, 1) - a;
  const Vector3d side_2 = mesh.position(triangle, 2) - a;
  const Vector3d area = side_1.cross(side_2);
  const double scale = 1 / area.squaredNorm();
  const Matrix3d back = (first[1] - first[0]) * (scale * side_2.cross(area)).transpose() +
                        (first[2] - first[0]) * (scale * area.cross(side_1)).transpose();
  const FootPath path{.p_W = first[0] + back * (now.p_W - a), .J = back * now.J};
  if (!(path.p_W.allFinite() && path.J.allFinite())) return {.p_W = first[0]};
  return path;
}

}  // namespace thimble::render
