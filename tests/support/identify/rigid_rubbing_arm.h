#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>

#include "support/identify/hidden_arm.h"
#include "support/random.h"

namespace thimble::support {

// Typical friction of a joint, from which random values are drawn. Dry friction is 3.1 mN m, 25 mN
// at the tip, so that the probe's forces still move the arm with the friction of the tip. Viscous
// friction is ten times that of the tip there [chosen].
inline constexpr double kJointDry = 3.1e-3, kJointViscous = 1e-3;

/// Draws a rigid arm whose joints have 1/3 to 3 times these frictions. With an even seed the tip
/// has no friction of its own.
inline HiddenArm rigid_rubbing_arm(std::uint64_t seed) {
  HiddenArm arm = hidden_arm(seed);
  Random random(seed + 4000);
  const auto third_to_three = [&](double value) {
    return value * std::pow(3, random.uniform(-1, 1));
  };
  auto& simulated = arm.file.simulated;
  for (int i = 0; i < 3; ++i) simulated.drive_train.coulomb[i] = third_to_three(kJointDry);
  for (int i = 0; i < 3; ++i) simulated.drive_train.viscous[i] = third_to_three(kJointViscous);
  const double carried = simulated.drive_train.coulomb.minCoeff() / 0.14;  // N at either link's end
  simulated.plant.coulomb *= seed % 2 == 0 ? 0 : 0.5;
  simulated.plant.viscous *= seed % 2 == 0 ? 0 : 1;
  // No more weight than the friction supports.
  const double weight = random.uniform(0, 0.8) * (carried + simulated.plant.coulomb);
  simulated.weight_B = arm.file.R_WB.transpose() * Eigen::Vector3d(0, 0, -weight);
  return arm;
}

}  // namespace thimble::support
