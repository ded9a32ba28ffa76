#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "thimble/driver/export.h"
#include "thimble/driver/motor_currents.h"

namespace thimble::driver {

/// The size of the largest report any arm sends or takes, in bytes: the line buffer of the
/// Haptikfabriken boards [S forsslund/woodenhaptics firmware, buf_len]; a full-speed HID report has
/// half of it.
inline constexpr std::size_t kReportCapacity = 128;

/// Holds what one report from an arm says, still in the arm's own units.
struct ArmReading {
  std::array<std::int32_t, 3> counts{};     ///< Motor encoders, counts.
  std::array<std::int32_t, 3> auxiliary{};  ///< Gimbal encoders or whatever the arm sends there.
  std::uint16_t buttons = 0;                ///< One bit each.
  /// The report's own number, if the arm counts its reports; it tells old ones that come again.
  std::optional<std::uint16_t> number = std::nullopt;
};

/// Holds where an arm is. Frames: B arm base, T tip.
struct ArmPose {
  Eigen::Vector3d q{0, 0, 0};                      ///< Joint angles, rad.
  Eigen::Vector3d p_BT{0, 0, 0};                   ///< Tip in the base frame, m.
  Eigen::Matrix3d J_BT = Eigen::Matrix3d::Zero();  ///< d p_BT / d q, m/rad.
};

/// One kind of arm: its wire format and its geometry, both pure functions with no state. The
/// driver talks to every arm through it. Adding an arm means implementing it under arms/NAME/.
class THIMBLE_EXPORT Arm {
 public:
  Arm() = default;
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;
  virtual ~Arm() = default;

  /// Decodes one report. Total: any bytes of any length are either understood (true) or rejected
  /// (false, `reading` untouched). Real-time: safe.
  virtual bool decode(std::span<const std::byte> report, ArmReading& reading) const noexcept = 0;

  /// Encodes motor currents and returns how many bytes of `report` it filled.
  /// Real-time: safe.
  virtual std::size_t encode(const MotorCurrents& currents,
                             std::span<std::byte, kReportCapacity> report) const noexcept = 0;

  /// Finds joint angles, tip position and Jacobian of a reading, all of them. Real-time: safe.
  virtual void find_pose(const ArmReading& reading, ArmPose& pose) const noexcept = 0;
  /// Returns what `find_pose` finds. Real-time: safe.
  ArmPose pose(const ArmReading& reading) const noexcept {
    ArmPose pose;
    find_pose(reading, pose);
    return pose;
  }

  /// Returns how torque becomes current in each motor. Real-time: safe.
  virtual const std::array<MotorDrive, 3>& drives() const noexcept = 0;

  /// Returns whether the encoders count from zero at the pose in which the arm's board starts. Such
  /// an arm must be in its home pose then, and again after each restart of the board. False for an
  /// arm with absolute encoders, and for one that finds its own zero. Real-time: safe.
  virtual bool zero_at_power_on() const noexcept { return true; }

  /// Returns whether a gimbal is mounted whose encoders come with each reading. Real-time: safe.
  virtual bool has_gimbal() const noexcept { return false; }

  /// Finds the angles of the gimbal (rad) and the rotation of the stylus in the base, for a reading
  /// and its pose; without a gimbal it leaves both alone. Real-time: safe.
  virtual void orient(const ArmReading& /*reading*/, const ArmPose& /*pose*/,
                      Eigen::Vector3d& /*gimbal*/, Eigen::Matrix3d& /*R_BT*/) const noexcept {}
};

}  // namespace thimble::driver
