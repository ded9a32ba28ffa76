#include "hand/surface_probe.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "mesh/vertex_normals.h"

namespace thimble::scene {
namespace {

using Eigen::Vector3d;

// Returns the weights of the corners at the point of a triangle closest to p. Projects p onto the
// plane and, if the projection is outside, onto the sides. A triangle without area consists of its
// sides.
Vector3d closest_weights(const std::array<Vector3d, 3>& corner, const Vector3d& p) {
  const Vector3d ab = corner[1] - corner[0];
  const Vector3d ac = corner[2] - corner[0];
  const Vector3d normal = ab.cross(ac);
  const double area = normal.squaredNorm();
  if (area > 0) {
    const Vector3d ap = p - corner[0];
    const double v = ap.cross(ac).dot(normal) / area;
    const double w = ab.cross(ap).dot(normal) / area;
    if (v >= 0 && w >= 0 && v + w <= 1) return {1 - v - w, v, w};
  }
  Vector3d best{1, 0, 0};
  double best_distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    const Vector3d side = corner[j] - corner[i];
    const double length = side.squaredNorm();
    const double t = length > 0 ? std::clamp((p - corner[i]).dot(side) / length, 0.0, 1.0) : 0.0;
    const double distance = (corner[i] + t * side - p).squaredNorm();
    if (distance < best_distance) {
      best_distance = distance;
      best.setZero();
      best[static_cast<Eigen::Index>(i)] = 1 - t;
      best[static_cast<Eigen::Index>(j)] = t;
    }
  }
  return best;
}

std::array<Vector3d, 3> corners(const render::TriangleMesh& mesh, std::size_t triangle) {
  const auto& t = mesh.triangles[triangle];
  return {mesh.vertices[static_cast<std::size_t>(t[0])],
          mesh.vertices[static_cast<std::size_t>(t[1])],
          mesh.vertices[static_cast<std::size_t>(t[2])]};
}

std::vector<SphereTree::Sphere> spheres_around(const render::TriangleMesh& mesh) {
  std::vector<SphereTree::Sphere> spheres;
  for (std::size_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
    const std::array<Vector3d, 3> corner = corners(mesh, triangle);
    SphereTree::Sphere sphere{.center = (corner[0] + corner[1] + corner[2]) / 3};
    for (const Vector3d& c : corner) {
      sphere.radius = std::max(sphere.radius, (c - sphere.center).norm());
    }
    spheres.push_back(sphere);
  }
  return spheres;
}

}  // namespace

SurfaceProbe::SurfaceProbe(const render::TriangleMesh& mesh)
    : mesh_(mesh),
      normals_(render::vertex_normals(mesh)),
      spheres_(spheres_around(mesh)),
      tree_(spheres_) {
  Eigen::AlignedBox3d box;
  for (const auto& triangle : mesh.triangles) {
    for (const std::int32_t v : triangle) box.extend(mesh.vertices[static_cast<std::size_t>(v)]);
  }
  slack_ = 0.02 * box.diagonal().norm();  // [chosen: some tens of gathers along a path]
}

SurfacePoint SurfaceProbe::closest(const Vector3d& p_WQ) {
  if (candidates_.empty() || !((p_WQ - gathered_at_).norm() <= slack_)) gather(p_WQ);
  return closest_candidate(p_WQ);
}

void SurfaceProbe::gather(const Vector3d& p_WQ) {
  // The distance to a triangle is at most that to the far side of its sphere. While the query point
  // moves by at most `slack_`, a distance changes by at most `slack_`. So the list contains every
  // triangle that can become the closest.
  tree_.find_within(p_WQ, tree_.nearest_far_side(p_WQ) + 2 * slack_, candidates_);
  gathered_at_ = p_WQ;
}

SurfacePoint SurfaceProbe::closest_candidate(const Vector3d& p_WQ) const {
  SurfacePoint best;
  double best_distance = std::numeric_limits<double>::infinity();
  for (const std::size_t i : candidates_) {
    const double reach = spheres_[i].distance(p_WQ) - spheres_[i].radius;
    if (reach > 0 && reach * reach > best_distance) continue;
    const std::array<Vector3d, 3> corner = corners(mesh_, i);
    const Vector3d weights = closest_weights(corner, p_WQ);
    const Vector3d p_WS = weights[0] * corner[0] + weights[1] * corner[1] + weights[2] * corner[2];
    const double distance = (p_WS - p_WQ).squaredNorm();
    if (!(distance < best_distance)) continue;
    best_distance = distance;
    best.p_WS = p_WS;
    best.triangle = i;
    best.n_W.setZero();
    for (std::size_t k = 0; k < 3; ++k) {
      best.n_W += weights[static_cast<Eigen::Index>(k)] *
                  normals_[static_cast<std::size_t>(mesh_.triangles[i][k])];
    }
  }
  best.n_W.normalize();
  return best;
}

}  // namespace thimble::scene
