#pragma once

#include <Eigen/Core>
#include <optional>
#include <variant>

#include "thimble/driver/arm_model.h"
#include "thimble/driver/export.h"

namespace thimble::device_sim {

/// Inverse kinematics of an arm of any geometry, for the plants of arms with one to three motors
/// that have no plant of their own (paddle, five-bar, straight axes). All functions are Real-time:
/// safe.
struct THIMBLE_EXPORT BoardGeometry {
  driver::ArmGeometry of;  ///< Geometry.

  /// Returns the number of motors; the tip moves on as many axes of the base.
  int motors() const noexcept { return driver::motor_count(of); }
  /// Computes the tip (m) and the Jacobian (m/rad).
  void forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
               Eigen::Matrix3d& J_BT) const noexcept {
    std::visit([&](const auto& build) { build.forward(q, p_BT, J_BT); }, of);
  }
  /// Returns the joint vector at p_BT (m); empty if out of reach.
  std::optional<Eigen::Vector3d> inverse(const Eigen::Vector3d& p_BT) const noexcept {
    return driver::inverse(of, p_BT);
  }
};

/// Returns the model of an arm with the inverse kinematics of its geometry. Real-time: safe.
inline driver::JointModel<BoardGeometry> board_model(const driver::ArmModel& model) noexcept {
  return {.geometry = {model.geometry}, .drives = model.drives, .encoders = model.encoders};
}

}  // namespace thimble::device_sim
