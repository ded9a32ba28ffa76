#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <cstdint>

#include "support/identify/hidden_arm.h"
#include "support/random.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::support {

/// Draws an arm of two rods and rotors that its driver does not know. Each has 1/3 to 3 times the
/// mass for a PHANTOM's size [chosen: links of 60 and 50 g, rotors of 15 g at the tip]; the tip is
/// light. Counterweights leave little weight, so that the tip stays in place.
inline HiddenArm linked_arm(std::uint64_t seed) {
  HiddenArm arm = hidden_arm(seed);
  Random random(seed + 300);
  const auto third_to_three = [&](double value) {
    return value * std::exp(random.uniform(-1, 1) * std::log(3.0));
  };
  const auto& build = std::get<driver::SerialArm>(arm.file.model.geometry);
  const double lb = build.length_b, lc = build.length_c;
  arm.file.simulated.plant.mass *= 0.3;
  auto& links = arm.file.simulated.links;
  const double mass_b = third_to_three(0.06), mass_c = third_to_three(0.05);
  for (Eigen::Index i = 0; i < 3; ++i) links.inertia[i] = third_to_three(3e-4);
  links.yaw_b = mass_b * lb * lb / 3 + mass_c * lb * lb;
  links.yaw_c = mass_c * lc * lc / 3;
  links.inertia[1] += links.yaw_b;
  links.inertia[2] += links.yaw_c;
  links.coupling = mass_c * lb * lc / 2;
  // A tenth of the friction, at the end of either link.
  const double moment = 0.1 * arm.file.simulated.plant.coulomb / 9.80665;
  links.moment_b = random.uniform(-moment, moment) * lb;
  links.moment_c = random.uniform(-moment, moment) * lc;
  arm.weight *= 0.3;
  arm.file.simulated.weight_B *= 0.3;
  links.gravity_B = arm.file.R_WB.transpose() * Eigen::Vector3d(0, 0, -9.80665);
  return arm;
}

/// Returns the mass matrix at the tip of a simulated serial arm at joint angles q, kg, from the
/// sums in device_sim::LinkSettings.
inline Eigen::Matrix3d tip_masses(const scene::ArmFile& file, const Eigen::Vector3d& q) {
  const auto& links = file.simulated.links;
  const double sin_b = std::sin(q[1]), sin_c = std::sin(q[2]);
  Eigen::Matrix3d M = links.inertia.asDiagonal();
  M(0, 0) += links.yaw_b * sin_b * sin_b + links.yaw_c * sin_c * sin_c +
             2 * links.coupling * sin_b * sin_c;
  M(1, 2) = M(2, 1) = links.coupling * std::cos(q[1] + q[2]);
  const Eigen::Matrix3d G = std::get<driver::SerialArm>(file.model.geometry).jacobian(q).inverse();
  return file.simulated.plant.mass * Eigen::Matrix3d::Identity() + G.transpose() * M * G;
}

}  // namespace thimble::support
