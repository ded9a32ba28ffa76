#include <algorithm>

#include "thimble/device_sim/settings.h"

namespace thimble::device_sim {

driver::Result<void> WiringSettings::check() const {
  const auto there = [](std::uint8_t joint) { return joint < 3; };
  const bool good = std::all_of(encoder_of.begin(), encoder_of.end(), there) &&
                    std::all_of(motor_of.begin(), motor_of.end(), there) &&
                    encoder_gain.allFinite() && motor_gain.allFinite();
  if (good) return {};
  return driver::Error{
      "The simulated arm's wiring names a joint that is not there or a gain that is not finite; "
      "joints are 0, 1 and 2."};
}

Eigen::Vector3d WiringSettings::inputs(const Eigen::Vector3d& counts) const noexcept {
  Eigen::Vector3d seen;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    seen[k] = encoder_gain[k] * counts[encoder_of[i]];
  }
  return seen;
}

Eigen::Vector3d WiringSettings::motors(const Eigen::Vector3d& outputs) const noexcept {
  Eigen::Vector3d amperes(0, 0, 0);
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    amperes[motor_of[i]] += motor_gain[k] * outputs[k];
  }
  return amperes;
}

}  // namespace thimble::device_sim
