#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "support/random.h"
#include "thimble/scene/arm_file.h"

namespace thimble::support {

/// An arm whose simulated side has constants that its driver does not know.
struct HiddenArm {
  scene::ArmFile file;           ///< What the driver believes, and how the arm is simulated.
  std::array<double, 3> gain{};  ///< True torque over what the driver asks for.
  double weight = 0;             ///< N
  double delay = 0;              ///< Both ways together, s.
};

/// Draws one: mass and friction 1/3 to 3 times the published, gains 0.6 to 1.6, delays up to 4 ms,
/// and no more weight than its friction carries.
inline HiddenArm hidden_arm(std::uint64_t seed) {
  Random random(seed);
  HiddenArm arm{.file = scene::load_arm("vintage_phantom").value()};
  const auto third_to_three = [&](double value) {
    return value * std::exp(random.uniform(-1, 1) * std::log(3.0));
  };
  auto& simulated = arm.file.simulated;
  simulated.plant.mass = third_to_three(simulated.plant.mass);
  simulated.plant.viscous = third_to_three(simulated.plant.viscous);
  simulated.plant.coulomb = third_to_three(simulated.plant.coulomb);
  simulated.wire.delay_out_ns = static_cast<std::int64_t>(random.uniform(0, 4e6));
  arm.delay = 1e-9 * static_cast<double>(simulated.wire.delay_in_ns + simulated.wire.delay_out_ns);
  for (std::size_t i = 0; i < 3; ++i) {
    arm.gain[i] = random.uniform(0.6, 1.6);
    simulated.firmware.wiring.motor_gain[static_cast<Eigen::Index>(i)] = arm.gain[i];
  }
  arm.weight = random.uniform(0, 0.8) * simulated.plant.coulomb;
  simulated.weight_B = arm.file.R_WB.transpose() * Eigen::Vector3d(0, 0, -arm.weight);
  return arm;
}

}  // namespace thimble::support
