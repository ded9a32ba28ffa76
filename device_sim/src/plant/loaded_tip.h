#pragma once

#include <Eigen/Core>

#include "plant/axis_dynamics.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// A tip as a hand holds it and as it is when the hand has let go, with a mass fixed to it or none.
class LoadedTip {
 public:
  /// Makes one without a mass; `weight_B` pulls on it (N). Fails as AxisDynamics::make does.
  static driver::Result<LoadedTip> make(const PlantSettings& bare, const HandSettings& hand,
                                        const Eigen::Vector3d& weight_B);

  /// Fixes a mass (kg, 0: none) to it, in place of one that was there; gravity_B (m/s^2) pulls on
  /// that. Fails, and changes nothing, if the mass is negative or one of them not finite.
  /// Real-time: never from the servo thread.
  driver::Result<void> fix_mass(double mass, const Eigen::Vector3d& gravity_B);

  /// Gives it to another hand. Fails, and changes nothing, as `make` does. Real-time: never from
  /// the servo thread.
  driver::Result<void> take_hand(const HandSettings& hand);

  /// Returns how it moves. Real-time: safe.
  const AxisDynamics& dynamics(bool held) const noexcept { return held ? held_ : free_; }
  /// Returns what pulls on it, its own weight and the mass', N. Real-time: safe.
  const Eigen::Vector3d& pull_B() const noexcept { return pull_B_; }

 private:
  LoadedTip(const PlantSettings& loaded, const AxisDynamics& held, const AxisDynamics& free,
            const Eigen::Vector3d& weight_B) noexcept
      : bare_mass_(loaded.mass),
        loaded_(loaded),
        held_(held),
        free_(free),
        weight_B_(weight_B),
        pull_B_(weight_B) {}

  double bare_mass_;  // kg
  PlantSettings loaded_;
  HandSettings hand_;
  AxisDynamics held_, free_;
  Eigen::Vector3d weight_B_, pull_B_;  // N
};

}  // namespace thimble::device_sim
