#pragma once

#include <Eigen/Core>

#include "plant/axis_dynamics.h"
#include "thimble/device_sim/settings.h"
#include "thimble/driver/result.h"

namespace thimble::device_sim {

/// Dynamics of a tip that a hand holds, and of the same tip after the hand has let go, with or
/// without a mass fixed to it.
class LoadedTip {
 public:
  /// Makes a tip without a mass; `weight_B` acts on it (N). Fails like AxisDynamics::make.
  static driver::Result<LoadedTip> make(const PlantSettings& bare, const HandSettings& hand,
                                        const Eigen::Vector3d& weight_B);

  /// Fixes a mass (kg, 0: none) to the tip and replaces an earlier one; gravity_B (m/s^2) acts on
  /// it. Fails, and changes nothing, if the mass is negative or a number is not finite. Real-time:
  /// never from the servo thread.
  driver::Result<void> fix_mass(double mass, const Eigen::Vector3d& gravity_B);

  /// Replaces the hand. Fails, and changes nothing, like `make`. Real-time: never from the servo
  /// thread.
  driver::Result<void> take_hand(const HandSettings& hand);

  /// Returns the dynamics of the tip. Real-time: safe.
  const AxisDynamics& dynamics(bool held) const noexcept { return held ? held_ : free_; }
  /// Returns the weight of tip and mass, N. Real-time: safe.
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
