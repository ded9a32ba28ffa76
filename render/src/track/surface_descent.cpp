#include "track/surface_descent.h"

#include <Eigen/Geometry>
#include <limits>

namespace thimble::render {
namespace {

using Eigen::Vector3d;

std::size_t next_of(std::size_t k) noexcept {
  return k == 2 ? 0 : k + 1;
}

Vector3d unit_normal(const ContactMesh& mesh, std::int32_t t) noexcept {
  const Vector3d& a = mesh.position(t, 0);
  return (mesh.position(t, 1) - a).cross(mesh.position(t, 2) - a).normalized();
}

bool below_edge(const ContactMesh& mesh, std::int32_t t, std::size_t k,
                const Vector3d& d) noexcept {
  return d.dot(unit_normal(mesh, t) + unit_normal(mesh, mesh.cell(t).neighbours[k])) < 0;
}

// Slides over the faces around a place to the one that leads nearest to the tip, and adds the
// number of closest points computed. Returns false if none leads nearer.
bool slide_on(const ContactMesh& mesh, const SurfacePlace& place, const Vector3d& p_OT, Rest& rest,
              std::size_t& examined) noexcept {
  bool moved = false;
  const auto consider = [&](std::int32_t t) noexcept {
    const TriangleClosestPoint closest = closest_on(mesh, t, p_OT);
    // Strictly, so that the same point seen from another triangle does not count as progress.
    if (!(closest.distance_squared < rest.closest.distance_squared)) return;
    rest.closest = closest;
    moved = true;
  };
  if (place.on == SurfacePlace::On::kEdge) {
    consider(mesh.cell(place.triangle).neighbours[place.k]);
    ++examined;
  } else {
    const auto fan = mesh.fan(mesh.corners(place.triangle)[place.k]);
    for (const std::int32_t t : fan) consider(t);
    examined += fan.size();
  }
  rest.hops = static_cast<std::uint16_t>(rest.hops + moved);
  return moved;
}

}  // namespace

Rest descend(const ContactMesh& mesh, const SurfacePlace& from, const Vector3d& p_OT) noexcept {
  Rest rest;
  rest.closest = closest_on(mesh, from.triangle, p_OT);
  std::size_t examined = 1;
  if (from.on != SurfacePlace::On::kFace) slide_on(mesh, from, p_OT, rest, examined);
  while (rest.closest.place.on != SurfacePlace::On::kFace) {
    if (examined >= kExaminedMax) return rest;
    const SurfacePlace place = rest.closest.place;
    if (!slide_on(mesh, place, p_OT, rest, examined)) break;
  }
  rest.settled = true;
  return rest;
}

bool below(const ContactMesh& mesh, const Rest& rest, const Vector3d& p_OT) noexcept {
  const Vector3d d = p_OT - rest.closest.p_OP;
  const SurfacePlace& place = rest.closest.place;
  if (place.on == SurfacePlace::On::kFace) return d.dot(rest.closest.normal) < 0;
  if (place.on == SurfacePlace::On::kEdge) return below_edge(mesh, place.triangle, place.k, d);

  // At a settled corner every direction within the surface points away from the tip. Seen from the
  // tip, the edge that does so least is not hidden by another part of the surface. So its two faces
  // decide on which side the tip is, for any shape of the fan.
  const std::int32_t vertex = mesh.corners(place.triangle)[place.k];
  std::int32_t best = place.triangle;
  std::size_t best_edge = place.k;
  double best_slope = -std::numeric_limits<double>::infinity();
  for (const std::int32_t t : mesh.fan(vertex)) {
    const auto& corners = mesh.corners(t);
    const std::size_t k = corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
    const Vector3d edge = mesh.position(corners[next_of(k)]) - mesh.position(vertex);
    const double slope = d.dot(edge) / edge.norm();
    if (!(slope > best_slope)) continue;
    best = t;
    best_edge = k;
    best_slope = slope;
  }
  return below_edge(mesh, best, best_edge, d);
}

}  // namespace thimble::render
