#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace thimble::render {

/// The closest point of a surface found so far by a query. In steps of a SearchFrame.
struct NearestSoFar {
  double squared = 0;           ///< Squared distance beyond which triangles are not wanted.
  Eigen::Vector3d to{0, 0, 0};  ///< From the query point.
  std::int32_t triangle = -1;   ///< -1 for none yet.
};

}  // namespace thimble::render
