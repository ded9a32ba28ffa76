#pragma once

#include "thimble/driver/arm.h"
#include "thimble/driver/joint_model.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::driver::hfab {

using driver::JointEncoder;

/// Describes an arm that speaks the 14-byte report: data of one model, no state.
struct HfabModel {
  SerialArm geometry;                    ///< Links and home pose.
  std::array<MotorDrive, 3> drives;      ///< Motors.
  std::array<JointEncoder, 3> encoders;  ///< Encoders.
  /// True if encoders d, e, f carry the fractions (1/65536) of counts a, b, c. No real arm does;
  /// the simulated arm uses it for ideal encoders (step below a nanometre), to show what the steps
  /// cost.
  bool fractional_counts = false;

  /// Tells the joint angle of one encoder step, rad. Real-time: safe.
  double step(int joint) const noexcept;

  /// Turns the counter values of a reading into joint angles, rad. Real-time: safe.
  Eigen::Vector3d joint_angles(const ArmReading& reading) const noexcept;

  /// Is the inverse of `joint_angles` before rounding: counter values at joint angles q (rad).
  /// Real-time: safe.
  Eigen::Vector3d exact_counts(const Eigen::Vector3d& q) const noexcept;
};

/// Is a serial arm that speaks the 14-byte report.
class HfabArm final : public Arm {
 public:
  explicit HfabArm(const HfabModel& model) : model_(model) {}

  bool decode(std::span<const std::byte> report, ArmReading& reading) const noexcept override;
  std::size_t encode(const MotorCurrents& currents,
                     std::span<std::byte, kReportCapacity> report) const noexcept override;
  ArmPose pose(const ArmReading& reading) const noexcept override;
  const std::array<MotorDrive, 3>& drives() const noexcept override { return model_.drives; }

  const HfabModel& model() const noexcept { return model_; }

 private:
  HfabModel model_;
};

}  // namespace thimble::driver::hfab
