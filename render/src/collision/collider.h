#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "thimble/render/body/motion_choice.h"

namespace thimble::render {

/// Simple shape, in a separate frame.
enum class ColliderForm : std::uint8_t {
  kPoints,     ///< Convex hull of `points`.
  kTriangles,  ///< Surface of `points` and `triangles`.
  kBox,        ///< Half sides `size`.
  kSphere,     ///< Radius `size.x`.
  kCylinder,   ///< Radius `size.x`, half height `size.z`, along z.
  kCone,       ///< Radius of the base `size.x`, half height `size.z`, its tip along +z.
  kCapsule,    ///< Radius `size.x`, half height of the cylinder `size.z`, along z.
  kHalfSpace,  ///< Below the plane z = 0.
};

/// A shape that collides, as data. m.
struct Collider {
  ColliderForm form = ColliderForm::kPoints;
  Eigen::Vector3d size{0, 0, 0};
  std::vector<Eigen::Vector3d> points;
  std::vector<std::array<std::int32_t, 3>> triangles;
  Eigen::Matrix3d R =
      Eigen::Matrix3d::Identity();  ///< Turns from the shape's frame to the owner's.
  Eigen::Vector3d p{0, 0, 0};       ///< Origin of the shape's frame in the owner's.
};

/// Returns the half-space below a plane with the unit normal `n` through `p`, in the owner's frame.
inline Collider half_space(const Eigen::Vector3d& n, const Eigen::Vector3d& p) {
  Collider plane;
  plane.form = ColliderForm::kHalfSpace;
  plane.R = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), n).toRotationMatrix();
  plane.p = p;
  return plane;
}

/// Several shapes that belong to one object, and how it rebounds and slides.
struct ColliderSet {
  std::vector<Collider> shapes;
  double friction = 0.5;   ///< Coefficient, >= 0. A pair has the geometric mean of both.
  double restitution = 0;  ///< 0 to 1. A pair has the larger one.
};

}  // namespace thimble::render
