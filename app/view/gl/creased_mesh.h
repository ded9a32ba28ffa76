#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::view {

/// How much each polygon counts in the normal of a vertex.
enum class NormalWeights {
  kAngle,  ///< As wide as its angle there: cutting up a flat polygon changes no normal.
  kEqual,  ///< All the same, as it was done when triangles were few [BP].
};

/// A mesh ready to be drawn: a vertex has one normal, the mean of its polygons, except where
/// they meet in a crease: there each side of the crease has its own.
struct CreasedMesh {
  std::vector<Eigen::Vector3f> positions;               ///< m, in the mesh's frame.
  std::vector<Eigen::Vector3f> normals;                 ///< Unit.
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< In the mesh's order.
  std::vector<std::array<std::uint32_t, 2>> edges;      ///< Each of the mesh's edges once.
  bool closed = false;  ///< Each edge has two triangles that turn alike, outside is outside.
};

/// Splits a mesh at its creases: where the normals of two polygons differ by more than
/// `crease_angle` (rad). Triangles without area lend no normal.
/// Precondition: triangles name vertices that exist. Real-time: never from the servo thread.
CreasedMesh crease(const render::TriangleMesh& mesh, double crease_angle,
                   NormalWeights weights = NormalWeights::kAngle);

}  // namespace thimble::view
