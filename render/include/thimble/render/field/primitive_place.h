#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace thimble::render {

/// Where a tip lies against a solid shape.
struct PrimitivePlace {
  double depth = 0;              ///< Below the surface along `n_W`, m; not above 0: outside.
  Eigen::Vector3d n_W{0, 0, 0};  ///< Outward unit normal.
  std::int32_t face = 0;         ///< Number of the face that is felt.
};

}  // namespace thimble::render
