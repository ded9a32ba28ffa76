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

/// Capacity of a report buffer, bytes. The largest report of any arm fits: the line buffer of the
/// Haptikfabriken boards [S forsslund/woodenhaptics firmware, buf_len]. A full-speed HID report is
/// half as long.
inline constexpr std::size_t kReportCapacity = 128;

/// Contents of one report from an arm, in the arm's own units.
struct ArmReading {
  std::array<std::int32_t, 3> counts{};  ///< Motor encoders, counts.
  /// Counts of gimbal encoders, or other values that the arm sends in the same fields.
  std::array<std::int32_t, 3> auxiliary{};
  std::uint16_t buttons = 0;  ///< Buttons, one bit each.
  /// Sequence number of the report, if the arm sends one; used to detect repeated reports.
  std::optional<std::uint16_t> number = std::nullopt;
};

/// Pose of an arm. Frames: B arm base, T tip.
struct ArmPose {
  Eigen::Vector3d q{0, 0, 0};                      ///< Joint angles, rad.
  Eigen::Vector3d p_BT{0, 0, 0};                   ///< Position of the tip in the base frame, m.
  Eigen::Matrix3d J_BT = Eigen::Matrix3d::Zero();  ///< Jacobian d p_BT / d q, m/rad.
};

/// Interface of one kind of arm that has a wire format: its wire format and its geometry, both
/// stateless pure functions. WireLink accesses these arms through it (ArmLink). To add an arm,
/// implement this interface in driver/src/arms/NAME/.
class THIMBLE_EXPORT Arm {
 public:
  Arm() = default;
  Arm(const Arm&) = delete;
  Arm& operator=(const Arm&) = delete;
  virtual ~Arm() = default;

  /// Decodes one report. Accepts any bytes of any length. Returns false and leaves `reading`
  /// unchanged if they are not a valid report. Real-time: safe.
  virtual bool decode(std::span<const std::byte> report, ArmReading& reading) const noexcept = 0;

  /// Encodes motor currents into `report` and returns the number of bytes written. Real-time: safe.
  virtual std::size_t encode(const MotorCurrents& currents,
                             std::span<std::byte, kReportCapacity> report) const noexcept = 0;

  /// Computes joint angles, tip position and Jacobian from a reading. Real-time: safe.
  virtual void find_pose(const ArmReading& reading, ArmPose& pose) const noexcept = 0;
  /// Returns the pose computed by `find_pose`. Real-time: safe.
  ArmPose pose(const ArmReading& reading) const noexcept {
    ArmPose pose;
    find_pose(reading, pose);
    return pose;
  }

  /// Returns the conversion from torque to current for each motor. Real-time: safe.
  virtual const std::array<MotorDrive, 3>& drives() const noexcept = 0;

  /// Returns whether the encoders count from zero at the pose that the arm has when its board
  /// starts. Such an arm must be in its home pose at every start of the board. False for an arm
  /// with absolute encoders, and for one that finds its own zero. Real-time: safe.
  virtual bool zero_at_power_on() const noexcept { return true; }

  /// Returns whether the arm has a gimbal whose encoder counts are part of each reading. Real-time:
  /// safe.
  virtual bool has_gimbal() const noexcept { return false; }

  /// Computes the gimbal angles (rad) and the rotation of the stylus in the base from a reading and
  /// its pose. If the arm has no gimbal, leaves both unchanged. Real-time: safe.
  virtual void orient(const ArmReading& /*reading*/, const ArmPose& /*pose*/,
                      Eigen::Vector3d& /*gimbal*/, Eigen::Matrix3d& /*R_BT*/) const noexcept {}
};

}  // namespace thimble::driver
