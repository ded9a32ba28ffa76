#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>

#include "thimble/driver/arm.h"
#include "thimble/driver/export.h"
#include "thimble/driver/motor_currents.h"
#include "thimble/driver/safety_gate.h"

namespace thimble::driver {

/// Capabilities of an arm. Constant for the lifetime of a link.
struct ArmTraits {
  bool has_joints = false;       ///< True if joint angles and Jacobian are those of the arm.
  bool has_counts = false;       ///< True if encoder counts are those of the arm.
  bool has_velocity = false;     ///< True if the arm measures its velocity.
  bool has_orientation = false;  ///< True if the arm reports the orientation of the stylus.
  bool has_gimbal = false;       ///< True if the angles of the gimbal axes are known.
  bool has_gripper = false;      ///< True if the arm has a gripper.
  /// True if the encoders count from zero at the pose in which the arm's board starts
  /// (Arm::zero_at_power_on).
  bool zero_at_power_on = false;
  /// Number of axes of the base along which the tip can move and forces act: the first, the first
  /// two, or all three. Less than 3 for an arm with one or two motors.
  int axes = 3;
  /// Motors for which the link converts forces into currents; requires joints. If empty, the arm
  /// takes a force, and the host does not know currents, limits or heat of its motors.
  std::optional<std::array<MotorDrive, 3>> motors{};

  friend bool operator==(const ArmTraits&, const ArmTraits&) = default;
};

/// Last sample of an arm. Frames: B base of the arm, T tip. A link sets the members listed in its
/// traits and leaves the others unchanged.
struct ArmSample {
  /// Tip p_BT (m). If the arm has joints, also their angles q (rad) and the Jacobian J_BT (m/rad).
  /// Otherwise the axes of the base are used as joints, and J_BT is the identity.
  ArmPose pose{.q = {0, 0, 0}, .p_BT = {0, 0, 0}, .J_BT = Eigen::Matrix3d::Identity()};
  std::array<std::int32_t, 3> counts{};  ///< Encoder counts.
  /// Buttons, one bit each; bit 0 is the first button.
  std::uint16_t buttons = 0;
  Eigen::Vector3d v_BT{0, 0, 0};                       ///< Measured velocity of the tip, m/s.
  Eigen::Matrix3d R_BT = Eigen::Matrix3d::Identity();  ///< Rotation of the stylus in the base.
  Eigen::Vector3d gimbal{0, 0, 0};                     ///< Angles of the gimbal axes, rad.
  double gripper = 0;                                  ///< Gripper opening, m; 0: closed.
};

/// Status of a read or a write.
enum class LinkStatus : std::uint8_t {
  kOk,        ///< A new sample was read, or the force was sent.
  kNothing,   ///< Nothing new arrived before the deadline.
  kRejected,  ///< The received data is invalid.
  kRepeated,  ///< The received report was a repetition of an earlier one.
  kLost,      ///< Disconnected. Permanent: every later call returns this too.
  kRefused,   ///< The arm is connected, but it is unknown whether it accepted the force.
};

/// Result of a read.
struct LinkRead {
  LinkStatus status = LinkStatus::kNothing;  ///< Status; the sample is valid only with kOk.
  std::uint32_t skipped = 0;                 ///< Number of older reports that were dropped.
};

/// Result of a write.
struct LinkWrite {
  LinkStatus status = LinkStatus::kRefused;  ///< Status: kOk, kRefused or kLost.
  /// Fraction of the force that remains after the limits of the arm, 0 to 1.
  double scale = 1;
};

/// Connection between a Device and an arm: provides poses and accepts gated forces. WireLink
/// implements it for arms with a wire format and a geometry. An arm behind a vendor library or
/// service has its own implementation.
///
/// Used by one thread at a time. After construction it does not allocate, lock, or wait beyond a
/// deadline. The destructor closes the connection and is not called on the servo thread.
class THIMBLE_EXPORT ArmLink {
 public:
  ArmLink() = default;
  ArmLink(const ArmLink&) = delete;
  ArmLink& operator=(const ArmLink&) = delete;
  virtual ~ArmLink() = default;

  /// Returns the capabilities of the arm. Real-time: safe.
  virtual const ArmTraits& traits() const noexcept = 0;

  /// Reads the newest sample of the arm. `deadline_ns` is on the loop's clock; a deadline in the
  /// past means "do not wait". Real-time: safe; waits no longer than the deadline.
  virtual LinkRead read(ArmSample& sample, std::int64_t deadline_ns) noexcept = 0;

  /// Sends a force that the safety gate has passed. Zero force must be sent at any pose. `sample`
  /// is the last sample of the arm. `R_WB` is the rotation of its base in the world, the frame of
  /// the force. Real-time: safe; waits no longer than one exchange with the arm.
  virtual LinkWrite write(const GatedForce& force, const ArmSample& sample,
                          const Eigen::Matrix3d& R_WB) noexcept = 0;

  /// Returns the result of the last write, for a link that queues a force before the arm accepts
  /// it: kOk, kNothing (in transit), kRefused or kLost. Real-time: safe; does not wait.
  virtual LinkStatus settled() noexcept { return LinkStatus::kOk; }

  /// Returns whether reports carry a sequence number or timestamp. If not, an unchanging position
  /// is treated as suspicious. Real-time: safe.
  virtual bool numbers_reports() const noexcept { return false; }

  /// Returns the motor currents requested by the last write; zero for links without motors.
  /// Real-time: safe.
  virtual MotorCurrents currents() const noexcept { return {}; }

  /// Sets the largest motor currents from the next write on (`current_max` of `limits`, A). Called
  /// only for links with motors. Real-time: safe.
  virtual void limit_currents(const std::array<MotorDrive, 3>& /*limits*/) noexcept {}
};

}  // namespace thimble::driver
