#include "compact_mesh/outside_offset.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mesh/closest_point.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

// Below this the faces are back to back and the plane between them is rounding (contact_mesh.cpp).
constexpr double kBackToBack = 1e-7;

// Minimum weight of a point that counts as within a triangle, not on its border: rounding of
// weights.
constexpr double kInTriangle = 1e-9;

Vector3d area_of(const PackedTriangle& r) noexcept {
  const Vector3d corner = r.corner(0);
  return (r.corner(1) - corner).cross(r.corner(2) - corner);
}

}  // namespace

double side_of_crease(const Vector3d& p, const PackedTriangle& own, std::size_t edge,
                      const PackedTriangle& other) noexcept {
  const Vector3d area = area_of(own);
  const Vector3d other_area = area_of(other);
  const double twice_area = std::sqrt(area.squaredNorm());
  const Vector3d average = area / twice_area + other_area / std::sqrt(other_area.squaredNorm());
  const double size = average.norm();
  if (!(size > kBackToBack)) return 0;
  const Vector3d begin = own.corner(edge);
  const Vector3d along = own.corner((edge + 1) % 3) - begin;
  return average.cross(along).dot(p - begin) / (size * twice_area);
}

OffsetResponse feel_nearest(const Vector3d& p, const PackedTriangle& r,
                            const OffsetTriangle& offset) noexcept {
  const Vector3d a = r.corner(0), b = r.corner(1), c = r.corner(2);
  const Vector3d q = closest_point(p, a, b, c);
  const Vector3d area = area_of(r);
  const double per_squared = 1 / area.squaredNorm();
  OffsetPlace place;
  place.l1 = (c - a).cross(area).dot(q - a) * per_squared;
  place.l2 = area.cross(b - a).dot(q - a) * per_squared;
  place.l0 = 1 - place.l1 - place.l2;
  OffsetResponse felt = offset.feel(place);
  const Vector3d out = q - p;
  const double distance = std::sqrt(out.squaredNorm());
  const double over = std::min(std::min(place.l0, place.l1), place.l2);
  // Next to the triangle the closest point itself holds the tip. The corner normals may lean away
  // from it, and would leave a tip that is inside without force.
  if (!(over > kInTriangle) && distance > kPlaced) return {out / distance, distance};
  felt.depth = std::max(out.dot(felt.n_W), 0.0);
  return felt;
}

}  // namespace thimble::render
