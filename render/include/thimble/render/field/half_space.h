#pragma once

#include <Eigen/Core>

#include "thimble/render/field/primitive_place.h"

namespace thimble::render {

/// Half-space below a plane. A PrimitiveShape with one face [BP 2, the wall].
struct HalfSpace {
  Eigen::Vector3d n_W{0, 0, 1};   ///< Outward normal; the caller provides a unit vector.
  Eigen::Vector3d p_WO{0, 0, 0};  ///< Any point of the plane, m.

  /// Returns the depth of a point (W, m) below the plane, with the normal. NaN is outside.
  /// Real-time: safe.
  PrimitivePlace place(const Eigen::Vector3d& p_W, const Eigen::Vector3d&) const noexcept {
    return {.depth = n_W.dot(p_WO - p_W), .n_W = n_W};
  }

  /// Returns whether a point (W, m) is below the plane. Real-time: safe.
  bool inside(const Eigen::Vector3d& p_W) const noexcept { return n_W.dot(p_WO - p_W) > 0; }
};

}  // namespace thimble::render
