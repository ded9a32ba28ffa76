#pragma once

#include <Eigen/Core>
#include <cmath>

#include "thimble/render/field/box.h"

namespace thimble::render {

/// Returns whether a coordinate (m) in a box's frame is between two of its faces. Exactly on a
/// face, it is decided as if all points in W were shifted by (e, e^2, e^3) with an infinitely small
/// e > 0. So a point in the common plane of two boxes is in one of them. Real-time: safe.
inline bool between_faces(const Box& box, double x, Eigen::Index axis) noexcept {
  const double half = box.half_sides[axis];
  if (std::abs(x) < half) return true;
  // Written so that NaN is outside.
  if (!(std::abs(x) == half)) return false;
  double shift = 0;
  for (Eigen::Index k = 0; k < 3 && shift == 0; ++k) shift = box.R_WO(k, axis);
  return shift * x < 0;
}

}  // namespace thimble::render
