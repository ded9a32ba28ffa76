#pragma once

#include "stability/friction_rig.h"
#include "studies/accuracy/accuracy_axis.h"
#include "studies/friction/friction_cases.h"

namespace thimble::studies {

/// What a friction does under a hand that creeps at 1 mm/s, N.
struct Creep {
  double limit_cycle = 0;  ///< RMS above 50 Hz.
  double mean = 0;         ///< Against the motion.
};

/// Creeps on the rig for 3 s, of which the last second counts. Real-time: never from the servo
/// thread.
Creep creep_of(const FrictionCase& which, const stability::FrictionRigSettings& rig);

/// Makes a stroke of the friction alone ready: `kFrictionTicks` ticks of a creeping tip.
Stroke friction_work(const FrictionCase& which, const stability::FrictionRigSettings& rig);
inline constexpr int kFrictionTicks = 4000;

}  // namespace thimble::studies
