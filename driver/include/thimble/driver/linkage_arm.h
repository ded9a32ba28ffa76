#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <string_view>

#include "thimble/driver/export.h"

namespace thimble::driver {

/// Geometry of the Polhem arm: a yaw joint, and in its plane two motors next to each other that
/// move the forearm through a four-bar linkage [S forsslund/hfabapi hfab_polhem.h].
///
///     h |            elbow            bar 1 from the front motor to the elbow, at angle q1
///       |      1   . o - - -forearm-> T   length_5 from elbow to tip, at angle lambda
///       |     .   / 4                 bar 4 continues the forearm backwards
///       |  . o - o                    bar 2 on the back motor, at angle q2
///       | o 2  3                      bar 3 joins the ends of 2 and 4
///   --- back - - front - - r          the motors are length_0 apart, the yaw axis half-way
///
/// Frame B: origin on the yaw axis between the motors, z up. Joint vector q = (yaw, q1, q2), rad,
/// both link angles measured from the r axis. All functions are Real-time: safe.
struct THIMBLE_EXPORT LinkageArm {
  double length_0 = 0;  ///< Between the two motors, m.
  double length_1 = 0;  ///< Front motor to elbow, m.
  double length_2 = 0;  ///< Crank on the back motor, m.
  double length_3 = 0;  ///< Coupling bar, m.
  double length_4 = 0;  ///< Elbow back to the coupling bar, m.
  double length_5 = 0;  ///< Elbow to tip, m.

  /// Computes the tip p_BT (m) and the Jacobian J_BT = d p_BT / d q (m/rad). If the bars cannot
  /// close, both are NaN, so that all later stages give zero force.
  void forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
               Eigen::Matrix3d& J_BT) const noexcept;

  /// Returns the rotation R_BL of the forearm: x along it towards the tip, y level [S
  /// forsslund/hfabapi hfab_api.cpp, getRot]. NaN if the bars cannot close.
  Eigen::Matrix3d last_link(const Eigen::Vector3d& q, const Eigen::Vector3d& p_BT) const noexcept;

  /// Returns the joint angles at which the tip is at p_BT (m). The configuration is that in which
  /// the arm is built: elbow above the line from the front motor to the tip, crank behind its bar.
  /// Empty if the bars do not reach the point, or if it is not finite.
  std::optional<Eigen::Vector3d> inverse(const Eigen::Vector3d& p_BT) const noexcept;
};

/// Configuration of a five-bar that its motors cannot control.
enum class FiveBarPose : std::uint8_t {
  kRegular,      ///< None of the others.
  kOpen,         ///< The distal links do not meet.
  kStretched,    ///< The distal links are in line: no torque holds the tip across them.
  kFolded,       ///< The elbows coincide, or the distal links lie on each other.
  kLegStraight,  ///< A crank and its distal link are in line: the tip cannot move along them.
};

/// Returns the name of a configuration in messages ("distal links stretched"). Real-time: safe.
THIMBLE_EXPORT std::string_view name(FiveBarPose pose) noexcept;

/// Geometry of a planar arm of five bars (pantograph): two cranks on motors and two distal links
/// that meet at the tip.
///
///              T
///       d_1  /   \  d_2        crank k turns about motor k, at angle q_k from the x axis
///          /       \           the tip is on the left side of the line from elbow 1 to elbow 2
///   elbow 1         elbow 2
///          \       /           y
///       c_1 \     / c_2        |   the motors are `base` apart on the x axis,
///            1 - 2             +-- x   the origin half-way, motor 1 on the left
///
/// Frame B: z along the motor axes. The tip moves in the plane z = 0. Joint vector q = (q_1, q_2,
/// z): angles in rad, and the distance from the plane, m, which is 0 for every real arm. All
/// functions are Real-time: safe.
struct THIMBLE_EXPORT FiveBarArm {
  double base = 0;      ///< Between the two motors, m; 0: both on one axis.
  double crank_1 = 0;   ///< Crank on motor 1, m.
  double crank_2 = 0;   ///< Crank on motor 2, m.
  double distal_1 = 0;  ///< Elbow 1 to tip, m.
  double distal_2 = 0;  ///< Elbow 2 to tip, m.

  /// Returns the number of motors.
  static constexpr int motors() noexcept { return 2; }

  /// Computes the tip p_BT (m) and the Jacobian J_BT = d p_BT / d q (m/rad; its third column is the
  /// unit vector along z). If the distal links do not meet, both are NaN, so that all later stages
  /// give zero force.
  void forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
               Eigen::Matrix3d& J_BT) const noexcept;

  /// Returns the identity: the handle of such an arm has no orientation.
  Eigen::Matrix3d last_link(const Eigen::Vector3d&, const Eigen::Vector3d&) const noexcept {
    return Eigen::Matrix3d::Identity();
  }

  /// Returns the angles at which the tip is at p_BT (m), with both elbows outside as the arm is
  /// built: -pi/2 < q_1 < 5/2 pi, and -3/2 pi < q_2 < 3/2 pi. Empty if the links do not reach the
  /// point, if it is not in the plane, or if it is not finite.
  std::optional<Eigen::Vector3d> inverse(const Eigen::Vector3d& p_BT) const noexcept;

  /// Returns the configuration at angles q. An arm counts as singular if the sine of the angle
  /// between two links is below kSingular.
  FiveBarPose configuration(const Eigen::Vector3d& q) const noexcept;
  /// Sine of an angle between links below which a configuration is singular [chosen: 3 degrees;
  /// there the force of a motor is multiplied or divided by 19].
  static constexpr double kSingular = 0.052;

  friend bool operator==(const FiveBarArm&, const FiveBarArm&) = default;
};

}  // namespace thimble::driver
