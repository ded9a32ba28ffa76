#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace thimble::render {

/// The nearest point of a surface that a question has come upon. In steps of a SearchFrame.
struct NearestSoFar {
  double squared = 0;           ///< Squared distance beyond which no more triangles are wanted.
  Eigen::Vector3d to{0, 0, 0};  ///< From the point asked about.
  std::int32_t triangle = -1;   ///< -1 for none yet.
};

}  // namespace thimble::render
