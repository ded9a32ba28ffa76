#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace thimble::render {

/// A set of triangles over shared vertices: what files hold, before anything is known of it.
struct TriangleMesh {
  std::vector<Eigen::Vector3d> vertices;  ///< Positions, in the file's unit or in m.
  std::vector<std::array<std::int32_t, 3>>
      triangles;  ///< Vertex numbers, counter-clockwise from outside.
};

}  // namespace thimble::render
