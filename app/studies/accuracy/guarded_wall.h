#pragma once

#include <Eigen/Core>

#include "thimble/driver/energy_guard.h"
#include "thimble/driver/safety_gate.h"

namespace thimble::studies {

/// The arm in front of a guarded wall: PHANTOM-like [PHYSICS 0].
struct GuardedArm {
  static constexpr double kMass = 0.075;     ///< kg
  static constexpr double kViscous = 0.005;  ///< N s/m
  static constexpr double kTick = 1e-3;      ///< s
  static constexpr double kHand = 3;         ///< N s/m, of a pinch grip
};

/// Method that limits the energy from a wall: a stage of the product's gate, or a virtual coupling,
/// which the product does not have.
struct WallGuard {
  driver::EnergyStage stage = driver::EnergyStage::kNone;
  double allowance = 0;  ///< J, as in driver::EnergyGuardSettings.
  double onset = 0;      ///< J, as in driver::EnergyGuardSettings.
  /// Damping (N s/m) assumed by a coupling's limit; 0: no coupling.
  double counted_on = 0;
};

/// A wall behind a guard: the sent force of each tick, along one line.
///
/// The coupling is a spring and damper between the tip and a massless point that the wall stops by
/// an implicit step. Everything behind the coupling is therefore passive. Spring and damper are 1 /
/// 1.1 and 1 / 1.2 of the bound K T / 2 + B < b [PHYSICS 1.2 and 1.6, after Adams and Hannaford].
/// Real-time: safe, after construction.
class GuardedWall {
 public:
  GuardedWall(const WallGuard& guard, double stiffness);

  /// Takes the depth (m) of this tick and returns the outward force, N.
  double force(double depth) noexcept;

 private:
  double gated(double depth) noexcept;
  double coupled(double depth) noexcept;

  driver::SafetyGate gate_;
  WallGuard guard_;
  double stiffness_;
  double spring_ = 0, damper_ = 0;  // of the coupling
  double last_depth_ = 0;
  double last_point_ = 0;  // last position of the coupled point, m
  Eigen::Vector3d sent_{0, 0, 0};
  bool begun_ = false;
};

}  // namespace thimble::studies
