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

/// What an arm tells of itself beside where its tip is, and what it is driven by. It does not
/// change while a link lives.
struct ArmTraits {
  bool has_joints = false;       ///< Joint angles and Jacobian are the arm's.
  bool has_counts = false;       ///< Encoder counts are the arm's.
  bool has_velocity = false;     ///< The arm measures its velocity.
  bool has_orientation = false;  ///< The arm tells how the stylus is turned.
  bool has_gimbal = false;       ///< The angles of the gimbal's axes are known.
  bool has_gripper = false;      ///< The arm has a gripper.
  /// Encoders count from zero at the pose in which the arm's board starts (Arm::zero_at_power_on).
  bool zero_at_power_on = false;
  /// Motors that the link turns forces into currents for. None: the arm takes a force and keeps its
  /// motors to itself, their limits and their heat included. Motors need joints.
  std::optional<std::array<MotorDrive, 3>> motors{};

  friend bool operator==(const ArmTraits&, const ArmTraits&) = default;
};

/// What an arm told last. Frames: B base of the arm, T tip. A link fills in what its traits name
/// and leaves the rest alone.
struct ArmSample {
  /// Tip p_BT (m); with joints also their angles q (rad) and the Jacobian J_BT (m/rad). Without,
  /// the axes of the base stand for joints: J_BT is the identity.
  ArmPose pose{.q = {0, 0, 0}, .p_BT = {0, 0, 0}, .J_BT = Eigen::Matrix3d::Identity()};
  std::array<std::int32_t, 3> counts{};                ///< Of the encoders.
  std::uint16_t buttons = 0;                           ///< One bit each; bit 0 is the first.
  Eigen::Vector3d v_BT{0, 0, 0};                       ///< Measured velocity of the tip, m/s.
  Eigen::Matrix3d R_BT = Eigen::Matrix3d::Identity();  ///< Rotation of the stylus in the base.
  Eigen::Vector3d gimbal{0, 0, 0};                     ///< Angles of the gimbal's axes, rad.
  double gripper = 0;                                  ///< Opening of the gripper, m; 0: closed.
};

/// How a read or a write ended.
enum class LinkStatus : std::uint8_t {
  kOk,        ///< A new sample was read, or the force was handed over.
  kNothing,   ///< Nothing new arrived before the deadline.
  kRejected,  ///< What arrived cannot be understood.
  kRepeated,  ///< What arrived has been there before.
  kLost,      ///< The arm is gone; every later call says so too.
  kRefused,   ///< The arm is there, and whether it took the force is not known.
};

/// What became of a read.
struct LinkRead {
  LinkStatus status = LinkStatus::kNothing;  ///< Unless kOk the sample means nothing.
  std::uint32_t skipped = 0;                 ///< Older reports that were dropped.
};

/// What became of a write.
struct LinkWrite {
  LinkStatus status = LinkStatus::kRefused;  ///< kOk, kRefused or kLost.
  double scale = 1;  ///< What is left of the force after the limits of the arm, 0 to 1.
};

/// What stands between Device and an arm: it gives poses and takes gated forces. An arm that is
/// bytes on a wire and a geometry is behind a WireLink; one behind a vendor's library or a service
/// is a link of its own.
///
/// Used by one thread at a time; neither allocates nor locks nor waits beyond a deadline after it
/// was made. The destructor closes it; it is not called on the servo thread.
class THIMBLE_EXPORT ArmLink {
 public:
  ArmLink() = default;
  ArmLink(const ArmLink&) = delete;
  ArmLink& operator=(const ArmLink&) = delete;
  virtual ~ArmLink() = default;

  /// Returns what the arm tells and how it is driven. Real-time: safe.
  virtual const ArmTraits& traits() const noexcept = 0;

  /// Reads the newest that the arm tells. `deadline_ns` is on the loop's clock; one in the past
  /// means "do not wait". Real-time: safe; waits no longer than the deadline.
  virtual LinkRead read(ArmSample& sample, std::int64_t deadline_ns) noexcept = 0;

  /// Sends a force, which only the safety gate can make; zero force must go out at any pose.
  /// `sample` is where the arm is, `R_WB` how its base is turned in the world, in which the force
  /// is given. Real-time: safe; waits no longer than one exchange with the arm.
  virtual LinkWrite write(const GatedForce& force, const ArmSample& sample,
                          const Eigen::Matrix3d& R_WB) noexcept = 0;

  /// Returns what became of the last write, for a link that hands a force over before the arm takes
  /// it: kOk, kNothing (on its way), kRefused or kLost. Real-time: safe; does not wait.
  virtual LinkStatus settled() noexcept { return LinkStatus::kOk; }

  /// Returns whether old news are known as such, by a number or a time of their own; else a
  /// position that never changes is suspicious. Real-time: safe.
  virtual bool numbers_reports() const noexcept { return false; }

  /// Returns what the last write asked of the motors; of links with motors. Real-time: safe.
  virtual MotorCurrents currents() const noexcept { return {}; }

  /// Takes the largest currents that the motors may get from the next write on (`current_max` of
  /// `limits`, A); asked only of links with motors. Real-time: safe.
  virtual void limit_currents(const std::array<MotorDrive, 3>& /*limits*/) noexcept {}
};

}  // namespace thimble::driver
