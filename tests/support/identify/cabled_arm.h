#pragma once

#include <cmath>
#include <cstdint>

#include "support/identify/hidden_arm.h"
#include "support/random.h"

namespace thimble::support {

/// Adds elastic cables between motors and links: one to ten times `softest` (N m/rad), with motors
/// of one to nine times `lightest` (kg m^2).
inline void put_cables(HiddenArm& arm, std::uint64_t seed, double softest, double lightest) {
  Random random(seed + 1000);
  auto& train = arm.file.simulated.drive_train;
  for (int i = 0; i < 3; ++i) {
    train.stiffness[i] = softest * std::pow(10, random.uniform(0, 1));
    train.inertia[i] = lightest * std::pow(9, random.uniform(0, 1));
    train.damping[i] = train.stiffness[i] * random.uniform(1e-4, 1e-3);
  }
}

/// Draws a hidden arm with elastic cables of one to ten times `softest` (N m/rad), and motors of
/// 1e-4 to 9e-4 kg m^2.
inline HiddenArm cabled_arm(std::uint64_t seed, double softest = 20) {
  HiddenArm arm = hidden_arm(seed);
  put_cables(arm, seed, softest, 1e-4);
  return arm;
}

}  // namespace thimble::support
