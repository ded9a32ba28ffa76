#pragma once

#include <Eigen/Core>

#include "thimble/render/field/primitive_place.h"

namespace thimble::render {

/// Sphere; its force points away from the centre [BP 2]. A PrimitiveShape with one face.
struct Sphere {
  Eigen::Vector3d p_WO{0, 0, 0};  ///< Centre in the world, m.
  double radius = 0;              ///< Radius, m, > 0.

  /// Returns the depth of a point (W, m) below the surface, with the normal. NaN is outside. At the
  /// exact centre the normal is the last one felt, or up if there was none. Real-time: safe.
  PrimitivePlace place(const Eigen::Vector3d& p_W,
                       const Eigen::Vector3d& n_before_W) const noexcept {
    const Eigen::Vector3d p_O = p_W - p_WO;
    // Divides by the largest coordinate first, so that no square under- or overflows.
    const double largest = p_O.cwiseAbs().maxCoeff();
    if (largest == 0) {
      const bool felt = n_before_W.squaredNorm() > 0;
      return {.depth = radius, .n_W = felt ? n_before_W : Eigen::Vector3d::UnitZ()};
    }
    const Eigen::Vector3d scaled = p_O / largest;
    const double length = scaled.norm();
    return {.depth = radius - largest * length, .n_W = scaled / length};
  }

  /// Returns the ratio of a path on the surface to that of a tip `depth` (m) below it; infinite at
  /// the centre. Real-time: safe.
  double stretch(double depth) const noexcept { return radius / (radius - depth); }

  /// Returns whether a point (W, m) is inside. Real-time: safe.
  bool inside(const Eigen::Vector3d& p_W) const noexcept { return (p_W - p_WO).norm() < radius; }
};

}  // namespace thimble::render
