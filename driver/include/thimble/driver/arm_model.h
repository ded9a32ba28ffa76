#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>
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

// Arms with one or two motors. The tip moves on the first axis or on the first two axes of the
// base: a line or a plane. A geometry with n motors has a function `int motors() const`. Its joint
// vector has n joint angles, then the coordinates of the tip along the other axes of the base (m).
// For a real arm these are 0. So the Jacobian is square and invertible, and its last 3 - n columns
// are unit vectors. Motors and encoders that an arm does not have are those of `absent_motor` and
// `absent_encoder`: the torque along the missing axes is computed, but no current.

/// Returns whether a tip (m) is on the first `motors` axes of the base, and finite; the tolerance
/// is 1 nm [chosen: far above rounding errors, far below any encoder]. Real-time: safe.
inline bool lies_on_axes(const Eigen::Vector3d& p_BT, int motors) noexcept {
  constexpr double kTolerance = 1e-9;  // m
  for (int axis = motors; axis < 3; ++axis) {
    if (!(std::abs(p_BT[axis]) <= kTolerance)) return false;
  }
  return p_BT.squaredNorm() < HUGE_VAL;
}

/// Returns the drive of a motor that an arm does not have: it never takes a current.
constexpr MotorDrive absent_motor() noexcept {
  return {.sign = 0, .ratio = 1, .torque_constant = 1, .current_max = 1};
}

/// Returns the encoder of a joint that an arm does not have: its angle is always 0. The number of
/// counts makes its step, 6e-12 m, smaller than any other [chosen].
constexpr JointEncoder absent_encoder() noexcept {
  return {.sign = 0, .counts_per_motor_turn = 1e12, .home_counts = 0};
}

/// Geometry of a paddle with one motor, such as the Hapkit: a handle on a sector that a capstan
/// turns. The tip is the point where the hand holds the handle. Its way along its arc is the x axis
/// of the base: x = handle q. So work is exact, tau dq = f dx. Joint vector q = (angle of the
/// sector in rad, y, z). All functions are Real-time: safe.
struct PaddleArm {
  double handle = 0;  ///< Pivot of the sector to the hand, m.

  static constexpr int motors() noexcept { return 1; }  ///< Returns the number of motors.
  /// Computes the tip (m) and the Jacobian (m/rad).
  void forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
               Eigen::Matrix3d& J_BT) const noexcept {
    p_BT = {handle * q[0], q[1], q[2]};
    J_BT = Eigen::Vector3d(handle, 1, 1).asDiagonal();
  }
  /// Returns the identity.
  Eigen::Matrix3d last_link(const Eigen::Vector3d&, const Eigen::Vector3d&) const noexcept {
    return Eigen::Matrix3d::Identity();
  }
  /// Returns the joint vector at p_BT (m). Empty if the point is not on the line, more than half a
  /// turn of the sector away, or not finite.
  std::optional<Eigen::Vector3d> inverse(const Eigen::Vector3d& p_BT) const noexcept {
    const double angle = p_BT.x() / handle;
    if (!lies_on_axes(p_BT, motors()) || !(std::abs(angle) <= std::numbers::pi)) {
      return std::nullopt;
    }
    return Eigen::Vector3d(angle, 0, 0);
  }

  friend bool operator==(const PaddleArm&, const PaddleArm&) = default;
};

/// Geometry of an arm with one to three straight axes, each moved by a belt, a rack or a cable. The
/// joints are the axes of the base. Joint vector q: the angles of the pulleys in rad, then the
/// coordinates along the axes without a motor. All functions are Real-time: safe.
struct CartesianArm {
  /// Way of the tip along each axis per radian of its pulley, m/rad: the pulley's radius. Axes
  /// without a motor have 1.
  Eigen::Vector3d radius{1, 1, 1};
  int axes = 3;  ///< Number of axes with a motor, 1 to 3.

  int motors() const noexcept { return axes; }  ///< Returns the number of motors.
  /// Computes the tip (m) and the Jacobian (m/rad), which is diagonal.
  void forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
               Eigen::Matrix3d& J_BT) const noexcept {
    p_BT = radius.cwiseProduct(q);
    J_BT = radius.asDiagonal();
  }
  /// Returns the identity.
  Eigen::Matrix3d last_link(const Eigen::Vector3d&, const Eigen::Vector3d&) const noexcept {
    return Eigen::Matrix3d::Identity();
  }
  /// Returns the joint vector at p_BT (m). Empty if the point is not on the axes of the arm or not
  /// finite. The ends of the axes are unknown to the geometry; they are in the workspace.
  std::optional<Eigen::Vector3d> inverse(const Eigen::Vector3d& p_BT) const noexcept {
    if (!lies_on_axes(p_BT, axes)) return std::nullopt;
    Eigen::Vector3d q = p_BT.cwiseQuotient(radius);
    for (int axis = axes; axis < 3; ++axis) q[axis] = 0;
    return q;
  }

  friend bool operator==(const CartesianArm&, const CartesianArm&) = default;
};

/// Arm geometries that Thimble supports. To add one, add a type here and a row of `kArmShapes`
/// (arm_table.h). The compiler then reports every place that must handle it.
using ArmGeometry = std::variant<SerialArm, LinkageArm, DeltaArm, VendorPoseArm, PaddleArm,
                                 FiveBarArm, CartesianArm>;

/// Returns the number of motors of an arm, 1 to 3: the number of axes of its base along which the
/// tip can move. Real-time: safe.
template <class Geometry>
int motor_count(const Geometry& geometry) noexcept {
  if constexpr (requires { geometry.motors(); }) return geometry.motors();
  return 3;
}
/// Returns the same for any geometry. Real-time: safe.
inline int motor_count(const ArmGeometry& geometry) noexcept {
  return std::visit([](const auto& build) { return motor_count(build); }, geometry);
}

/// Returns 1 for each axis of the base along which the tip of an arm with `motors` motors can move,
/// else 0. A force on the tip acts only along these axes. Real-time: safe.
inline Eigen::Vector3d free_axes(int motors) noexcept {
  return {1, motors > 1 ? 1.0 : 0.0, motors > 2 ? 1.0 : 0.0};
}

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
