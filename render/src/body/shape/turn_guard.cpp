#include "body/shape/turn_guard.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Minimum share of the first area, seen along the first normal: far above rounding, and small
// enough for walls of 80 degrees around a pit. [chosen]
constexpr double kAreaShareMin = 0.15;

Vector3d twice_area(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return (b - a).cross(c - a);
}

}  // namespace

TurnGuard::TurnGuard(const ContactMesh& mesh) {
  seen_along_.reserve(mesh.triangles_max());
  for (std::int32_t t = 0; t < mesh.triangle_count(); ++t) {
    const Vector3d area = twice_area(mesh.position(t, 0), mesh.position(t, 1), mesh.position(t, 2));
    const double squared = area.squaredNorm();
    seen_along_.push_back(squared > 0 ? Vector3d(area / squared) : Vector3d::Zero());
  }
}

double TurnGuard::allowed(const ContactMesh& mesh, std::span<const Vector3d> places,
                          std::int32_t vertex, const Vector3d& p_W) const noexcept {
  const Vector3d& place = places[static_cast<std::size_t>(vertex)];
  const Vector3d way = p_W - place;
  if (!way.allFinite()) return 0;
  double allowed = 1;
  for (const std::int32_t t : mesh.fan(vertex)) {
    const auto& corners = mesh.corners(t);
    const std::size_t k = corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
    const Vector3d& along = seen_along_[static_cast<std::size_t>(t)];
    const Vector3d& b = places[static_cast<std::size_t>(corners[(k + 1) % 3])];
    const Vector3d& c = places[static_cast<std::size_t>(corners[(k + 2) % 3])];
    // The area's vector is linear in the place of one corner.
    const double now = along.dot(twice_area(place, b, c));
    const double change = along.dot(way.cross(b - c));
    if (now + change >= kAreaShareMin || change >= 0) continue;
    // Written so that NaN allows nothing.
    const double share = (now - kAreaShareMin) / -change;
    allowed = share > 0 ? std::min(allowed, share) : 0;
  }
  return allowed;
}

}  // namespace thimble::render
