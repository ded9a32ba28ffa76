#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

#include "thimble/driver/delta_arm.h"
#include "thimble/driver/joint_model.h"
#include "thimble/driver/linkage_arm.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::driver {

/// Geometry of an arm whose tip position a vendor service or library reports. Joint vector q =
/// p_BT, m: the axes of the base are used as joints, as in ArmSample. All functions are Real-time:
/// safe.
struct VendorPoseArm {
  /// Computes the tip (m) and the Jacobian, which is the identity.
  void forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
               Eigen::Matrix3d& J_BT) const noexcept {
    p_BT = q;
    J_BT.setIdentity();
  }
  /// Returns the identity, because the orientation of the last link is unknown.
  Eigen::Matrix3d last_link(const Eigen::Vector3d&, const Eigen::Vector3d&) const noexcept {
    return Eigen::Matrix3d::Identity();
  }
  /// Returns `p_BT`; empty if it is not finite.
  std::optional<Eigen::Vector3d> inverse(const Eigen::Vector3d& p_BT) const noexcept {
    if (!p_BT.allFinite()) return std::nullopt;
    return p_BT;
  }
};

/// Former name of VendorPoseArm.
using ToldArm [[deprecated("renamed to VendorPoseArm")]] = VendorPoseArm;

/// Arm geometries that Thimble supports. To add one, add a type here and a row of `kArmShapes`
/// (arm_table.h). The compiler then reports every place that must handle it.
using ArmGeometry = std::variant<SerialArm, LinkageArm, DeltaArm, VendorPoseArm>;

/// Model of an arm with any geometry.
using ArmModel = JointModel<ArmGeometry>;

/// Converts the model of a specific geometry to ArmModel. Real-time: safe.
template <class Geometry>
ArmModel arm_model(const JointModel<Geometry>& model) noexcept {
  return {.geometry = model.geometry,
          .drives = model.drives,
          .encoders = model.encoders,
          .gimbal = model.gimbal};
}

/// Returns the model with its specific geometry. Precondition: the arm has that geometry; otherwise
/// throws std::bad_variant_access. Real-time: never from the servo thread.
template <class Geometry>
JointModel<Geometry> model_as(const ArmModel& model) {
  return {.geometry = std::get<Geometry>(model.geometry),
          .drives = model.drives,
          .encoders = model.encoders,
          .gimbal = model.gimbal};
}

/// Returns the joint angles at which the tip is at p_BT (m); empty if the arm cannot reach the
/// point. Real-time: safe.
inline std::optional<Eigen::Vector3d> inverse(const ArmGeometry& geometry,
                                              const Eigen::Vector3d& p_BT) noexcept {
  return std::visit([&](const auto& build) { return build.inverse(p_BT); }, geometry);
}

}  // namespace thimble::driver
