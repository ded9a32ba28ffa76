#pragma once

#include "stability/friction_rig.h"
#include "studies/accuracy/accuracy_axis.h"
#include "studies/friction/friction_cases.h"

namespace thimble::studies {

/// Effect of a friction on a hand that creeps at 1 mm/s, N.
struct Creep {
  double limit_cycle = 0;  ///< RMS above 50 Hz.
  double mean = 0;         ///< Against the motion.
};

/// Creeps on the rig for 3 s, and evaluates the last second. Real-time: never from the servo
/// thread.
Creep creep_of(const FrictionCase& which, const stability::FrictionRigSettings& rig);

/// Prepares a stroke of only the friction: `kFrictionTicks` ticks of a creeping tip.
Stroke friction_work(const FrictionCase& which, const stability::FrictionRigSettings& rig);
inline constexpr int kFrictionTicks = 4000;

}  // namespace thimble::studies
