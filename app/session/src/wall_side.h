#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>

namespace thimble::session {

/// Returns the side of the workspace whose wall pushes with `f_W` (N), by the largest component:
/// "+x" for the wall at the largest x, which pushes towards smaller x.
inline std::string wall_side(const Eigen::Vector3d& f_W) {
  Eigen::Index axis = 0;
  f_W.cwiseAbs().maxCoeff(&axis);
  return std::string(f_W[axis] < 0 ? "+" : "-") + "xyz"[axis];
}

}  // namespace thimble::session
