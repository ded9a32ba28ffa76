#pragma once

#include <vector>

#include "studies/accuracy/held_motion.h"

namespace thimble::studies {

// The true motion of one axis of the PHANTOM-like arm [PHYSICS 0], pushed for a second by a force
// that a servo loop holds for 1 ms each. Real-time: never from the servo thread.

/// The arm, and the hand in the case without dry friction. SI.
struct PushedArm {
  static constexpr double kMass = 0.075;     ///< kg
  static constexpr double kViscous = 0.005;  ///< N s/m
  static constexpr double kCoulomb = 0.04;   ///< N
  static constexpr double kTick = 1e-3;      ///< s
  static constexpr int kTicks = 1000;
  static constexpr double kHandStiffness = 300;  ///< N/m, in the smooth case
  static constexpr double kHandDamping = 3;      ///< N s/m
};

/// Returns the force of each tick, N: steps of up to 0.25 N around 0, each held for 20 to 60 ms.
const std::vector<double>& pushing_forces();

/// Returns position and speed at the end of each tick with dry friction: the closed form of each
/// slide, with the time of its stop, in long double. Shares no code with the simulator.
std::vector<LineMotion> pushed_with_dry_friction();

/// Returns the same without dry friction, with the hand's spring and damper: the closed form of the
/// damped oscillator by its complex root.
std::vector<LineMotion> pushed_in_hand();

}  // namespace thimble::studies
