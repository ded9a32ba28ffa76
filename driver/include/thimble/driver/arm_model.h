#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

#include "thimble/driver/delta_arm.h"
#include "thimble/driver/joint_model.h"
#include "thimble/driver/linkage_arm.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::driver {

/// The geometry of an arm that tells where its tip is, by its vendor's service or library. Joint
/// vector q = p_BT, m: the axes of the base stand for joints, as in ArmSample. All functions are
/// Real-time: safe.
struct ToldArm {
  /// Returns the tip and the Jacobian, which is the identity.
  void forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
               Eigen::Matrix3d& J_BT) const noexcept {
    p_BT = q;
    J_BT.setIdentity();
  }
  /// Returns the axes of the base: nothing is known of a last link.
  Eigen::Matrix3d last_link(const Eigen::Vector3d&, const Eigen::Vector3d&) const noexcept {
    return Eigen::Matrix3d::Identity();
  }
  /// Returns the tip itself; empty if it is not finite.
  std::optional<Eigen::Vector3d> inverse(const Eigen::Vector3d& p_BT) const noexcept {
    if (!p_BT.allFinite()) return std::nullopt;
    return p_BT;
  }
};

/// The builds of arms that Thimble knows. A new build is one more type here and one more row of
/// `kArmShapes` (arm_table.h); the compiler then names every place that has to know it.
using ArmGeometry = std::variant<SerialArm, LinkageArm, DeltaArm, ToldArm>;

/// One model of an arm, whatever its build.
using ArmModel = JointModel<ArmGeometry>;

/// Returns the model of an arm of known build as one of any build. Real-time: safe.
template <class Geometry>
ArmModel arm_model(const JointModel<Geometry>& model) noexcept {
  return {.geometry = model.geometry,
          .drives = model.drives,
          .encoders = model.encoders,
          .gimbal = model.gimbal};
}

/// Returns the model of an arm as one of its own build. Precondition: it is of that build; else it
/// throws std::bad_variant_access. Real-time: never from the servo thread.
template <class Geometry>
JointModel<Geometry> model_as(const ArmModel& model) {
  return {.geometry = std::get<Geometry>(model.geometry),
          .drives = model.drives,
          .encoders = model.encoders,
          .gimbal = model.gimbal};
}

/// Returns the joint angles that put the tip at p_BT (m); empty if the arm does not reach it.
/// Real-time: safe.
inline std::optional<Eigen::Vector3d> inverse(const ArmGeometry& geometry,
                                              const Eigen::Vector3d& p_BT) noexcept {
  return std::visit([&](const auto& build) { return build.inverse(p_BT); }, geometry);
}

}  // namespace thimble::driver
