#pragma once

#include <cmath>
#include <cstdint>

#include "support/hidden_arm.h"
#include "support/random.h"

namespace thimble::support {

/// Draws a hidden arm behind cables that stretch: 20 to 200 N m/rad, motors of 1e-4 to 9e-4 kg m^2.
inline HiddenArm cabled_arm(std::uint64_t seed) {
  HiddenArm arm = hidden_arm(seed);
  Random random(seed + 1000);
  auto& train = arm.file.simulated.drive_train;
  for (int i = 0; i < 3; ++i) {
    train.stiffness[i] = 20 * std::pow(10, random.uniform(0, 1));
    train.inertia[i] = 1e-4 * std::pow(9, random.uniform(0, 1));
    train.damping[i] = train.stiffness[i] * random.uniform(1e-4, 1e-3);
  }
  return arm;
}

}  // namespace thimble::support
