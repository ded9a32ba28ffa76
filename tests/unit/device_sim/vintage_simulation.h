#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "arms/hfab/hfab_report.h"
#include "simulated_arm.h"
#include "support/vintage_arm.h"

namespace thimble::device_sim {

/// Settings like those of a PHANTOM, with a hand in pinch grip [PHYSICS 0].
inline SimulatedArmSettings phantom_like() {
  SimulatedArmSettings settings;
  settings.plant = {.mass = 0.075, .viscous = 0.005, .coulomb = 0.04};
  settings.hand.mass = 0.025;
  settings.hand.stiffness = 300;
  settings.hand.damping = 3;
  settings.motors.current_max = 3;
  return settings;
}

/// The same without hand and friction: a pushed arm stays in motion.
inline SimulatedArmSettings free_arm() {
  SimulatedArmSettings settings = phantom_like();
  settings.hand = {};
  settings.plant = {.mass = 0.1, .viscous = 0, .coulomb = 0};
  return settings;
}

inline Eigen::Vector3d home_tip() {
  return support::vintage_model().geometry.forward(support::vintage_home());
}

inline HandPath resting_at(const Eigen::Vector3d& p_BH) {
  return HandPath::make({{0.0, p_BH}}).value();
}

inline auto drive_message(std::int16_t a_mA, std::int16_t b_mA, std::int16_t c_mA) {
  return driver::hfab::encode_output({.current_mA = {a_mA, b_mA, c_mA}, .command = 0});
}

/// Reads and decodes the newest report of an arm; empty on failure.
inline std::optional<driver::hfab::InputReport> take(SimulatedArm& arm) {
  std::array<std::byte, driver::kReportCapacity> buffer;
  std::uint32_t skipped = 0;
  const std::size_t size = arm.take_report(buffer, skipped);
  return driver::hfab::decode_input(std::span<const std::byte>(buffer).first(size));
}

}  // namespace thimble::device_sim
