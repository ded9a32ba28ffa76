#include "thimble/driver/arms/hfab/hfab_arm.h"

#include <numbers>

#include "thimble/driver/arms/hfab/hfab_wire.h"
#include "thimble/driver/wire_arm.h"

namespace thimble::driver::hfab {

namespace {
constexpr double kFraction = 65536;  // fractional_counts: parts of a count in encoders d, e, f
}  // namespace

double HfabModel::step(int joint) const noexcept {
  const auto i = static_cast<std::size_t>(joint);
  return 2 * std::numbers::pi / (encoders[i].counts_per_motor_turn * drives[i].ratio);
}

Eigen::Vector3d HfabModel::joint_angles(const ArmReading& reading) const noexcept {
  Eigen::Vector3d q;
  for (int joint = 0; joint < 3; ++joint) {
    const auto i = static_cast<std::size_t>(joint);
    double counts = reading.counts[i] + encoders[i].home_counts;
    if (fractional_counts) counts += reading.auxiliary[i] / kFraction;
    q[joint] = encoders[i].sign * counts * step(joint);
  }
  return q;
}

Eigen::Vector3d HfabModel::exact_counts(const Eigen::Vector3d& q) const noexcept {
  Eigen::Vector3d counts;
  for (int joint = 0; joint < 3; ++joint) {
    const auto i = static_cast<std::size_t>(joint);
    counts[joint] = encoders[i].sign * q[joint] / step(joint) - encoders[i].home_counts;
  }
  return counts;
}

bool HfabArm::decode(std::span<const std::byte> bytes, ArmReading& reading) const noexcept {
  const auto report = decode_input(bytes);
  if (!report) return false;
  for (std::size_t i = 0; i < 3; ++i) {
    reading.counts[i] = report->counts[i];
    // As fractions of a count these fields have no sign.
    reading.auxiliary[i] = model_.fractional_counts
                               ? static_cast<std::uint16_t>(report->counts[3 + i])
                               : report->counts[3 + i];
  }
  reading.buttons = static_cast<std::uint16_t>(report->info & 1);
  return true;
}

std::size_t HfabArm::encode(const MotorCurrents& currents,
                            std::span<std::byte, kReportCapacity> report) const noexcept {
  return ReportWire::encode(whole_mA(currents), report);
}

void HfabArm::orient(const ArmReading& reading, const ArmPose& pose, Eigen::Vector3d& gimbal,
                     Eigen::Matrix3d& R_BT) const noexcept {
  if (!has_gimbal()) return;
  gimbal = model_.gimbal->angles(reading.auxiliary);
  R_BT = model_.geometry.last_link(pose.q, pose.p_BT) * model_.gimbal->rotation(gimbal);
}

void HfabArm::find_pose(const ArmReading& reading, ArmPose& pose) const noexcept {
  pose.q = model_.joint_angles(reading);
  model_.geometry.forward(pose.q, pose.p_BT, pose.J_BT);
}

}  // namespace thimble::driver::hfab
