#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::view {

/// Weight of each polygon in the normal of a vertex.
enum class NormalWeights {
  kAngle,  ///< The polygon's angle at the vertex: splitting a flat polygon changes no normal.
  kEqual,  ///< The same for all, as was common for meshes with few triangles [BP].
};

/// A mesh ready to be drawn. A vertex has one normal, the mean of its polygons. At a crease each
/// side has its own normal.
struct CreasedMesh {
  std::vector<Eigen::Vector3f> positions;               ///< m, in the mesh's frame.
  std::vector<Eigen::Vector3f> normals;                 ///< Unit.
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< In the order of the mesh.
  std::vector<std::array<std::uint32_t, 2>> edges;      ///< Each edge of the mesh once.
  bool closed = false;  ///< Each edge joins two triangles with the same orientation.
};

/// Splits a mesh at its creases, where the normals of two polygons differ by more than
/// `crease_angle` (rad). Triangles without area contribute no normal.
/// Precondition: triangles name vertices that exist. Real-time: never from the servo thread.
CreasedMesh crease(const render::TriangleMesh& mesh, double crease_angle,
                   NormalWeights weights = NormalWeights::kAngle);

}  // namespace thimble::view
