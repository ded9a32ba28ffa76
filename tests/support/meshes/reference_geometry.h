#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::support {

// Slow and simple references that share no code with the library under test.

using Eigen::Vector3d;
using render::TriangleMesh;

inline const Vector3d& corner(const TriangleMesh& mesh, std::size_t triangle, std::size_t k) {
  return mesh.vertices[static_cast<std::size_t>(mesh.triangles[triangle][k])];
}

inline Vector3d outward_normal(const TriangleMesh& mesh, std::size_t t) {
  const Vector3d& a = corner(mesh, t, 0);
  return (corner(mesh, t, 1) - a).cross(corner(mesh, t, 2) - a).normalized();
}

/// Returns the sum of the solid angles of all triangles seen from `p`, divided by 4 pi: 1 inside a
/// closed mesh, 0 outside (van Oosterom and Strackee 1983).
inline double winding_number(const TriangleMesh& mesh, const Vector3d& p) {
  double sum = 0;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d a = corner(mesh, t, 0) - p;
    const Vector3d b = corner(mesh, t, 1) - p;
    const Vector3d c = corner(mesh, t, 2) - p;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    sum +=
        std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return sum / (2 * std::numbers::pi);
}

inline bool is_inside(const TriangleMesh& mesh, const Vector3d& p) {
  return winding_number(mesh, p) > 0.5;
}

/// Returns the closest point of a triangle: the projection along the normal if it is inside the
/// triangle, else the closest of the three sides' closest points.
inline Vector3d nearest_on_triangle(const Vector3d& p, const Vector3d& a, const Vector3d& b,
                                    const Vector3d& c) {
  const Vector3d n = (b - a).cross(c - a);
  const Vector3d on_plane = p - n * (n.dot(p - a) / n.squaredNorm());
  if (n.dot((b - a).cross(on_plane - a)) >= 0 && n.dot((c - b).cross(on_plane - b)) >= 0 &&
      n.dot((a - c).cross(on_plane - c)) >= 0) {
    return on_plane;
  }
  const auto on_side = [&p](const Vector3d& from, const Vector3d& to) -> Vector3d {
    const Vector3d side = to - from;
    return from + std::clamp(side.dot(p - from) / side.squaredNorm(), 0.0, 1.0) * side;
  };
  Vector3d nearest = on_side(a, b);
  for (const Vector3d& q : {on_side(b, c), on_side(c, a)}) {
    if ((q - p).norm() < (nearest - p).norm()) nearest = q;
  }
  return nearest;
}

/// The closest point of a mesh.
struct Nearest {
  std::size_t triangle = 0;
  Vector3d point{0, 0, 0};
  double distance = std::numeric_limits<double>::infinity();
};

inline Nearest nearest_on_mesh(const TriangleMesh& mesh, const Vector3d& p) {
  Nearest best;
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vector3d q =
        nearest_on_triangle(p, corner(mesh, t, 0), corner(mesh, t, 1), corner(mesh, t, 2));
    if ((q - p).norm() < best.distance) best = {t, q, (q - p).norm()};
  }
  return best;
}

/// Returns where a segment crosses a triangle, as a parameter from 0 to 1 (Moeller and Trumbore
/// 1997).
inline std::optional<double> pierce(const Vector3d& from, const Vector3d& to, const Vector3d& a,
                                    const Vector3d& b, const Vector3d& c) {
  const Vector3d d = to - from;
  const Vector3d h = d.cross(c - a);
  const double det = (b - a).dot(h);
  if (det == 0) return std::nullopt;
  const double u = (from - a).dot(h) / det;
  const Vector3d q = (from - a).cross(b - a);
  const double v = d.dot(q) / det;
  const double t = (c - a).dot(q) / det;
  if (u < 0 || v < 0 || u + v > 1 || t < 0 || t > 1) return std::nullopt;
  return t;
}

}  // namespace thimble::support
