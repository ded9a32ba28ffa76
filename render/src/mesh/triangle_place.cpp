#include "mesh/triangle_place.h"

#include <Eigen/Geometry>
#include <array>

namespace thimble::render {

using Eigen::Matrix3d;
using Eigen::Vector3d;

TrianglePlace edge_plane_place(const ContactMesh& mesh, std::int32_t triangle,
                               const Vector3d& p_WT) noexcept {
  TrianglePlace closest{.triangle = triangle, .weights = Vector3d::Constant(1.0 / 3)};
  const EdgePlaneSides sides = edge_plane_sides(mesh, triangle, p_WT);
  // As edge_plane_weights.
  if (!(sides.value.sum() > 0)) return closest;
  Vector3d value = sides.value;
  Matrix3d change = sides.change;
  for (Eigen::Index k = 0; k < 3; ++k) {
    if (value[k] >= 0) continue;
    value[k] = 0;
    change.row(k).setZero();
  }
  const double sum = value.sum();
  closest.weights = value / sum;
  closest.change = (change - closest.weights * change.colwise().sum()) / sum;
  return closest;
}

TrianglePlace offset_triangle_place(const std::array<Vector3d, 3>& x,
                                    const std::array<Vector3d, 3>& n, const Vector3d& weights,
                                    double depth) noexcept {
  TrianglePlace closest{.weights = weights};
  const Vector3d side_1 = x[1] - x[0] - depth * (n[1] - n[0]);
  const Vector3d side_2 = x[2] - x[0] - depth * (n[2] - n[0]);
  const Vector3d way_down = weights[0] * n[0] + weights[1] * n[1] + weights[2] * n[2];
  const double volume = side_1.cross(side_2).dot(way_down);
  // Turned over, or NaN.
  if (!(volume > 0)) return closest;
  closest.change.row(1) = side_2.cross(way_down).transpose() / volume;
  closest.change.row(2) = way_down.cross(side_1).transpose() / volume;
  closest.change.row(0) = -closest.change.row(1) - closest.change.row(2);
  closest.sink = -side_1.cross(side_2) / volume;
  return closest;
}

Vector3d offset_depth_slope(const std::array<Vector3d, 3>& n, const TrianglePlace& closest,
                            double depth) noexcept {
  const Vector3d& w = closest.weights;
  const Vector3d N = w[0] * n[0] + w[1] * n[1] + w[2] * n[2];
  const double size = N.norm();
  const Vector3d along = Vector3d(n[0].dot(N), n[1].dot(N), n[2].dot(N)) / size;
  return size * closest.sink + depth * (closest.change.transpose() * along);
}

Vector3d height_slope(const std::array<Vector3d, 3>& x, const std::array<Vector3d, 3>& n,
                      const TrianglePlace& closest) noexcept {
  const auto bulge = [&](std::size_t i, std::size_t j) { return (x[i] - x[j]).dot(n[i] - n[j]); };
  const double b01 = bulge(0, 1), b12 = bulge(1, 2), b20 = bulge(2, 0);
  const Vector3d& w = closest.weights;
  const Vector3d by_weight(w[1] * b01 + w[2] * b20, w[0] * b01 + w[2] * b12,
                           w[1] * b12 + w[0] * b20);
  return 0.5 * (closest.change.transpose() * by_weight);
}

TrianglePlace offset_triangle_place(const ContactMesh& mesh, const SmoothNormals& normals,
                                    std::int32_t triangle, const Vector3d& weights,
                                    double depth) noexcept {
  TrianglePlace closest = offset_triangle_place(
      {mesh.position(triangle, 0), mesh.position(triangle, 1), mesh.position(triangle, 2)},
      normals.corners(triangle), weights, depth);
  closest.triangle = triangle;
  return closest;
}

MovingPoint path_of(const ContactMesh& mesh, const TrianglePlace& closest) noexcept {
  // Relative to a corner, as the rows of `change` sum to 0: far from the origin no digits are lost.
  const Vector3d& a = mesh.position(closest.triangle, 0);
  const Vector3d side_1 = mesh.position(closest.triangle, 1) - a;
  const Vector3d side_2 = mesh.position(closest.triangle, 2) - a;
  return {.p_W = a + closest.weights[1] * side_1 + closest.weights[2] * side_2,
          .J = side_1 * closest.change.row(1) + side_2 * closest.change.row(2)};
}

MovingPoint carried_back(const ContactMesh& mesh, std::int32_t triangle,
                         const std::array<Vector3d, 3>& first, const MovingPoint& now) noexcept {
  const Vector3d& a = mesh.position(triangle, 0);
  const Vector3d side_1 = mesh.position(triangle, 1) - a;
  const Vector3d side_2 = mesh.position(triangle, 2) - a;
  const Vector3d area = side_1.cross(side_2);
  const double scale = 1 / area.squaredNorm();
  const Matrix3d back = (first[1] - first[0]) * (scale * side_2.cross(area)).transpose() +
                        (first[2] - first[0]) * (scale * area.cross(side_1)).transpose();
  const MovingPoint path{.p_W = first[0] + back * (now.p_W - a), .J = back * now.J};
  if (!(path.p_W.allFinite() && path.J.allFinite())) return {.p_W = first[0]};
  return path;
}

}  // namespace thimble::render
