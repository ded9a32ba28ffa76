#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace thimble::render {

/// Triangles with shared vertices, as stored in files; not checked.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;  ///< Positions, in the file's unit or in m.
  /// Vertex indices, counter-clockwise from outside.
  std::vector<std::array<std::int32_t, 3>> triangles;
};

}  // namespace thimble::render
