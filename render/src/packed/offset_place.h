#pragma once

#include <Eigen/Core>

namespace thimble::render {

/// Is where a tip stands in an offset triangle.
struct OffsetPlace {
  double l0 = 0, l1 = 0, l2 = 0;  ///< Weights; negative: outside the edge opposite of that corner.
  double depth = 0;               ///< d, in steps of the lattice.
  bool valid = false;             ///< False where the offset triangle is folded over.
};

/// Is what is felt at a place of an offset triangle.
struct OffsetResponse {
  Eigen::Vector3d n_W{0, 0, 0};  ///< Outward unit normal.
  double depth = 0;              ///< Below the smooth surface along n_W, in steps of the lattice.
};

}  // namespace thimble::render
