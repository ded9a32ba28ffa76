#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <utility>

#include "support/random.h"
#include "thimble/scene/arm_file.h"

namespace thimble::support {

/// An arm whose simulation has constants that its driver does not know.
struct HiddenArm {
  scene::ArmFile file;           ///< Parameters of the driver and of the simulation.
  std::array<double, 3> gain{};  ///< True torque divided by the torque that the driver requests.
  double weight = 0;             ///< N
  double delay = 0;              ///< Sum of both directions, s.
};

/// Draws an arm similar to that of a file: mass and friction 1/3 to 3 times the file's, gains 0.6
/// to 1.6, or 1/3 to 3 if `wide`, delays up to 4 ms, and no more weight than its friction supports.
inline HiddenArm hidden_arm_of(scene::ArmFile file, std::uint64_t seed, bool wide = false) {
  Random random(seed);
  HiddenArm arm{.file = std::move(file)};
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
    arm.gain[i] = wide ? third_to_three(1) : random.uniform(0.6, 1.6);
    simulated.firmware.wiring.motor_gain[static_cast<Eigen::Index>(i)] = arm.gain[i];
  }
  arm.weight = random.uniform(0, 0.8) * simulated.plant.coulomb;
  simulated.weight_B = arm.file.R_WB.transpose() * Eigen::Vector3d(0, 0, -arm.weight);
  return arm;
}

/// Draws an arm similar to the vintage PHANTOM.
inline HiddenArm hidden_arm(std::uint64_t seed) {
  return hidden_arm_of(scene::load_arm("vintage_phantom").value(), seed);
}

/// Draws one of the serial arms: mass, friction and each gain 1/3 to 3 times the published values,
/// delays up to 4 ms, and no more weight than its friction supports.
inline HiddenArm wide_hidden_arm(std::uint64_t seed) {
  constexpr std::array kNames = {"vintage_phantom", "woodenhaptics", "polhem"};
  return hidden_arm_of(scene::load_arm(kNames[seed % kNames.size()]).value(), seed, true);
}

/// Draws a hand at rest at the tip, from two fingers that barely touch it to a firm grip.
inline device_sim::HandSettings random_hand(std::uint64_t seed) {
  Random random(seed + 77);
  return {.mass = random.uniform(0, 0.05),
          .stiffness = 20 * std::exp(random.uniform(0, 1) * std::log(50.0)),
          .damping = random.uniform(0.5, 8),
          .tremor_amplitude = random.uniform(0, 2e-4)};
}

}  // namespace thimble::support
