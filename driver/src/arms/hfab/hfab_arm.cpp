#include "thimble/driver/arms/hfab/hfab_arm.h"
#include "arms/hfab/hfab_report.h"

#include <algorithm>
#include <cmath>
#include <numbers>

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
  OutputReport output;
  output.command = static_cast<std::int16_t>(Command::kDrive);
  for (std::size_t i = 0; i < 3; ++i) {
    // The currents are finite and within +-current_max, and a model with a limit beyond 32 A is
    // cut.
    const double mA = std::clamp(currents.amperes()[static_cast<int>(i)] * 1e3, -32767.0, 32767.0);
    output.current_mA[i] = static_cast<std::int16_t>(std::lround(mA));
  }
  const auto bytes = encode_output(output);
  std::copy(bytes.begin(), bytes.end(), report.begin());
  return bytes.size();
}

ArmPose HfabArm::pose(const ArmReading& reading) const noexcept {
  ArmPose pose;
  pose.q = model_.joint_angles(reading);
  model_.geometry.forward(pose.q, pose.p_BT, pose.J_BT);
  return pose;
}

}  // namespace thimble::driver::hfab
