#pragma once

#include <Eigen/Core>
#include <utility>

#include "axis_dynamics.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// A tip as a hand holds it, and as it is when the hand has let go.
struct LoadedTips {
  AxisDynamics held, free;
};

/// Returns a tip with a mass (kg) fixed to it that gravity_B (m/s^2) pulls on. Fails if the mass is
/// negative, or one of them not finite. Real-time: never from the servo thread.
inline driver::Result<LoadedTips> loaded_tips(const PlantSettings& bare, const HandSettings& hand,
                                              double mass, const Eigen::Vector3d& gravity_B) {
  // Written so that NaN is refused.
  if (!(mass >= 0) || !gravity_B.allFinite()) {
    return driver::Error{"The mass that is fixed to the tip must be 0 kg at least, and finite."};
  }
  PlantSettings loaded = bare;
  loaded.mass += mass;
  auto held = AxisDynamics::make(loaded, hand);
  if (!held) return held.error();
  auto free = AxisDynamics::make(loaded, {});
  if (!free) return free.error();
  return LoadedTips{*held, *free};
}

}  // namespace thimble::device_sim
