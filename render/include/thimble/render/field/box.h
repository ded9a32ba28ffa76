#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "thimble/render/field/primitive_place.h"

namespace thimble::render {

/// Solid box with any pose. Its faces are numbered -x, +x, -y, +y, -z, +z of its own frame O, from
/// 0.
struct Box {
  Eigen::Matrix3d R_WO = Eigen::Matrix3d::Identity();  ///< Rotation of the box in the world.
  Eigen::Vector3d p_WO{0, 0, 0};                       ///< Centre in the world, m.
  Eigen::Vector3d half_sides{0, 0, 0};                 ///< Half side lengths, m, each > 0.

  /// Transforms a point (W, m) into the box's frame, m. Real-time: safe.
  Eigen::Vector3d to_box(const Eigen::Vector3d& p_W) const noexcept {
    return R_WO.transpose() * (p_W - p_WO);
  }

  /// Returns the outward unit normal of a face in W. Real-time: safe.
  Eigen::Vector3d normal(std::int32_t face) const noexcept {
    return face % 2 == 0 ? Eigen::Vector3d(-R_WO.col(face / 2))
                         : Eigen::Vector3d(R_WO.col(face / 2));
  }

  /// Returns the depth of a point (O, m) below the plane of a face, m. Real-time: safe.
  double depth(const Eigen::Vector3d& p_O, std::int32_t face) const noexcept {
    const Eigen::Index axis = face / 2;
    return half_sides[axis] - (face % 2 == 0 ? -p_O[axis] : p_O[axis]);
  }

  /// Returns whether a point (W, m) is inside. Real-time: safe.
  bool inside(const Eigen::Vector3d& p_W) const noexcept {
    return (to_box(p_W).array().abs() < half_sides.array()).all();
  }
};

/// Box divided into wedges, one per face: the nearest face pushes [BP Fig. 2b]. A PrimitiveShape
/// with six faces.
///
/// At points equally near to two faces the force changes its direction but not its magnitude. No
/// closed path gains energy. Once the tip has passed the middle of a plate of thickness h, at
/// stiffness * h / 2, it is pushed out at the back [PHYSICS 3]. This is the counter-example of the
/// paper; EntryFaceContact avoids it.
struct WedgeBox : Box {
  /// Returns the nearest face of a point (W, m); the first of several. NaN is outside. Real-time:
  /// safe.
  PrimitivePlace place(const Eigen::Vector3d& p_W, const Eigen::Vector3d&) const noexcept {
    const Eigen::Vector3d p_O = to_box(p_W);
    Eigen::Index axis = 0;
    // NaN in any coordinate gives a depth that is not above 0.
    const double depth = (half_sides - p_O.cwiseAbs()).minCoeff<Eigen::PropagateNaN>(&axis);
    const std::int32_t face =
        2 * static_cast<std::int32_t>(axis) + (std::signbit(p_O[axis]) ? 0 : 1);
    return {.depth = depth, .n_W = normal(face), .face = face};
  }
};

}  // namespace thimble::render
