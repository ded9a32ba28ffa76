#include "bringup/identify/sent_torques.h"

#include <array>
#include <cstddef>

#include "thimble/driver/wire_arm.h"

namespace thimble::bringup {
namespace {

/// Returns the motor values (A) that the board decodes from the message for these currents (A).
std::array<double, 3> decoded(const driver::WireTable& wire, const std::array<double, 3>& amperes) {
  std::array<std::byte, driver::kReportCapacity> bytes{};
  const std::size_t size = wire.encode(amperes, bytes);
  driver::WireValues values;
  values.motors = amperes;  // unchanged by a message that cannot be decoded
  wire.command.read(std::span<const std::byte>(bytes).first(size), values);
  return values.motors;
}

}  // namespace

SentTorques::SentTorques(const scene::ArmFile& file) {
  for (std::size_t i = 0; i < 3; ++i) {
    const driver::MotorDrive& drive = file.model.drives[i];
    per_ampere_[static_cast<Eigen::Index>(i)] = drive.sign * drive.ratio * drive.torque_constant;
  }
  if (file.protocol != driver::ArmKind::kDescribed || file.wire == nullptr) return;
  wire_ = *file.wire;
  wire_->use_motors(file.model.drives);
}

Eigen::Vector3d SentTorques::sent(const Eigen::Vector3d& tau) const {
  std::array<double, 3> amperes{};
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    if (per_ampere_[k] == 0) continue;
    amperes[i] = tau[k] / per_ampere_[k];
    if (!wire_) amperes[i] = 1e-3 * driver::round_half_away(1e3 * amperes[i]);
  }
  if (wire_) amperes = decoded(*wire_, amperes);
  return per_ampere_.cwiseProduct(Eigen::Vector3d(amperes[0], amperes[1], amperes[2]));
}

}  // namespace thimble::bringup
