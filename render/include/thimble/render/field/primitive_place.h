#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace thimble::render {

/// Position of a tip relative to a solid shape.
struct PrimitivePlace {
  /// Depth below the surface along `n_W`, m; outside if not above 0.
  double depth = 0;
  Eigen::Vector3d n_W{0, 0, 0};  ///< Outward unit normal.
  std::int32_t face = 0;         ///< Number of the face that is felt.
};

}  // namespace thimble::render
