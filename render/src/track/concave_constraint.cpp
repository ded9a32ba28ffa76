#include "track/concave_constraint.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "track/surface_descent.h"

namespace thimble::render {

using Eigen::Vector3d;

namespace {

std::uint8_t corner_of(const ContactMesh& mesh, std::int32_t triangle,
                       std::int32_t vertex) noexcept {
  const auto& corners = mesh.corners(triangle);
  return corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
}

// Names an edge or corner by `wanted` if that triangle has it, else by the first triangle that has
// it. Otherwise rounding would decide which of several is nearer.
void name_place(const ContactMesh& mesh, std::int32_t wanted, SurfacePlace& place) noexcept {
  const std::int32_t vertex = mesh.corners(place.triangle)[place.k];
  if (place.on == SurfacePlace::On::kCorner) {
    std::int32_t named = place.triangle;
    for (const std::int32_t t : mesh.fan(vertex)) {
      if (t == wanted || (named != wanted && t < named)) named = t;
    }
    place.triangle = named;
    place.k = corner_of(mesh, named, vertex);
    return;
  }
  const std::int32_t behind = mesh.cell(place.triangle).neighbours[place.k];
  if (place.triangle == wanted || (behind != wanted && place.triangle < behind)) return;
  // In the neighbour, the edge ends where it begins here.
  place.triangle = behind;
  place.k = static_cast<std::uint8_t>((corner_of(mesh, behind, vertex) + 2) % 3);
}

}  // namespace

GrooveHold hold_in_groove(const ContactMesh& mesh, std::int32_t triangle,
                          const Vector3d& p_WT) noexcept {
  const Rest rest = descend(mesh, {.triangle = triangle}, p_WT);
  GrooveHold hold;
  if (!below(mesh, rest, p_WT)) return hold;
  hold.holds = true;
  hold.place = rest.closest.place;
  hold.hops = rest.hops;
  hold.p_WH = rest.closest.p_OP;
  hold.n_W = mesh.cell(hold.place.triangle).face.n;
  if (hold.place.on == SurfacePlace::On::kFace) {
    hold.depth = std::max(mesh.depth(hold.place.triangle, p_WT), 0.0);
    return hold;
  }
  name_place(mesh, triangle, hold.place);
  hold.depth = std::sqrt(rest.closest.distance_squared);
  if (hold.depth > kDirectionMin * mesh.depth_rounding()) {
    hold.n_W = (hold.p_WH - p_WT) / hold.depth;
  }
  return hold;
}

bool on_concave_crease(const ContactMesh& mesh, const SmoothNormals& normals,
                       const SurfacePlace& place) noexcept {
  const auto concave_crease = [&](std::int32_t t, std::size_t k) {
    return normals.crease(t, k) && mesh.concave_edge(t, k);
  };
  if (place.on == SurfacePlace::On::kFace) return false;
  if (place.on == SurfacePlace::On::kEdge) return concave_crease(place.triangle, place.k);
  const std::int32_t vertex = mesh.corners(place.triangle)[place.k];
  const auto fan = mesh.fan(vertex);
  return std::any_of(fan.begin(), fan.end(), [&](std::int32_t t) {
    const auto& corners = mesh.corners(t);
    const std::size_t k = corners[0] == vertex ? 0 : corners[1] == vertex ? 1 : 2;
    return concave_crease(t, k) || concave_crease(t, (k + 2) % 3);
  });
}

}  // namespace thimble::render
