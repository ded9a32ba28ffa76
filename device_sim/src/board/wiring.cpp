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
      "The simulated arm's wiring has an unknown joint or a gain that is not finite. Joints are 0, "
      "1 and 2."};
}

}  // namespace thimble::device_sim
