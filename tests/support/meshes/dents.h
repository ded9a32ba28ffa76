#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "mesh/contact_mesh.h"
#include "support/random.h"

namespace thimble::support {

/// Returns moves that press a dent of `depth` (m) into a mesh around vertex `centre`, along `way`
/// (unit). The dent fades to zero at `radius` (m); a tenth of it is random.
inline std::vector<render::VertexMove> dent(const render::ContactMesh& mesh, std::int32_t centre,
                                            const Eigen::Vector3d& way, double depth, double radius,
                                            Random& random) {
  std::vector<render::VertexMove> moves;
  const Eigen::Vector3d middle = mesh.position(centre);
  for (std::int32_t v = 0; v < mesh.vertex_count(); ++v) {
    const Eigen::Vector3d& p = mesh.position(v);
    const double share = (p - middle).norm() / radius;
    if (!(share < 1)) continue;
    const double fade = (1 - share * share) * (1 - share * share);
    moves.push_back({v, p + depth * fade * (way + random.in_box(0.1))});
  }
  return moves;
}

/// Returns moves back to the original vertices of a mesh.
inline std::vector<render::VertexMove> back_to(const std::vector<Eigen::Vector3d>& vertices,
                                               const std::vector<render::VertexMove>& moves) {
  std::vector<render::VertexMove> back;
  for (const render::VertexMove& move : moves) {
    back.push_back({move.vertex, vertices[static_cast<std::size_t>(move.vertex)]});
  }
  return back;
}

/// Returns the mean of the face normals around a vertex, unit.
inline Eigen::Vector3d outwards_at(const render::ContactMesh& mesh, std::int32_t vertex) {
  Eigen::Vector3d sum{0, 0, 0};
  for (const std::int32_t t : mesh.fan(vertex)) sum += mesh.cell(t).face.n;
  return sum.normalized();
}

}  // namespace thimble::support
