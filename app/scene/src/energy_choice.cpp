#include "energy_choice.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "loop_latency.h"
#include "math/elementary.h"
#include "worst_direction.h"

namespace thimble::scene {

double loop_delay(const ArmFile& arm) {
  if (!arm.can_simulate || arm.is<driver::DeltaArm>()) return 0.001;
  return 1e-9 *
         static_cast<double>(arm.simulated.wire.delay_in_ns + arm.simulated.wire.delay_out_ns);
}

driver::EnergyGuardSettings energy_settings(const ArmFile& arm, double rate,
                                            std::optional<driver::EnergyStage> scene) {
  const EnergyChoice& choice = arm.energy;
  const double delay = loop_delay(arm);
  const double latency = latency_of({.period = 1 / rate, .delay = delay});
  driver::EnergyGuardSettings settings;
  settings.stage = scene.value_or(choice.stage);
  settings.mass = choice.mass.value_or(arm.simulated.plant.mass);
  settings.allowance = choice.allowance.value_or(kEnergyAllowance);
  settings.reservoir = choice.reservoir.value_or(arm.declared.force * arm.declared.force /
                                                 (2 * arm.declared.stiffness));
  settings.onset = kEnergyOnset;
  settings.dissipation = arm.simulated.plant.viscous + kSureHandDamping;
  // One count moves the estimate by its gain times step over period.
  const double corner = 2 * std::numbers::pi * arm.velocity_corner_frequency;
  const double gain = corner > 0 ? -math::expm1(-corner / rate) : 1;
  settings.speed_floor = gain * rate * worst_over_workspace(arm, 3).encoder_step;
  settings.slope = choice.slope.value_or(stiffness_limit(arm.simulated.plant.viscous, latency));
  // Nothing but a ring of torques depends on it: beyond the ring's end the last one stands.
  settings.delay_ticks = static_cast<int>(
      std::min(std::round(delay * rate), double{driver::EnergyGuardSettings::kDelayMost}));
  return settings;
}

}  // namespace thimble::scene
