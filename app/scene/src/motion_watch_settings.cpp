#include "motion_watch_settings.h"

#include <algorithm>
#include <cmath>

#include "energy_guard_settings.h"

namespace thimble::scene {

driver::MotionWatchSettings motion_settings(const ArmFile& arm, double rate) {
  // Desk-top arms have 45 to 150 g [DEVICES 3]; the motion watch tolerates an error of the mass by
  // more than a factor of 1.4 in both directions.
  constexpr double kUsualMass = 0.1;  // kg
  constexpr double kDelayMax = 10;    // ticks; after that a force is not compared with the motion
  driver::MotionWatchSettings settings;
  const double simulated = arm.can_simulate ? arm.simulated.plant.mass : kUsualMass;
  settings.mass = arm.energy.mass.value_or(simulated);
  settings.delay_ticks = static_cast<int>(std::min(std::round(loop_delay(arm) * rate), kDelayMax));
  settings.max_hold = arm.hold_unchanged.value_or(settings.max_hold);
  return settings;
}

}  // namespace thimble::scene
