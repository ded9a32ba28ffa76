#pragma once

#include <functional>
#include <memory>

#include "studies/accuracy/velocity_estimates.h"

namespace thimble::studies {

/// A wall against which a held arm rests: a two-sided spring and a damper, computed once per tick.
/// The hand's damping is included in the arm's; its spring is negligible compared with the wall's.
struct RestedWall {
  double mass = 0.1;     ///< kg, of arm and hand [PHYSICS 0]
  double viscous = 3;    ///< N s/m, of arm and hand
  double damping = 0;    ///< N s/m, of the wall
  double period = 1e-3;  ///< s
  double delay = 0;      ///< s, from the measured position to the force
  double duration = 1;   ///< s, of an oscillation; uneven ticks need longer for a mean.
  /// Returns the length of tick k, s; if empty, all have `period`.
  std::function<double(int)> period_of = {};
  /// Makes the velocity estimate of the damper; if empty, the difference over a tick.
  std::function<std::unique_ptr<VelocityEstimate>()> estimate = {};
};

/// Returns the largest stiffness at which an oscillation of 1 mm decays, N/m, by bisection to 0.1
/// %; 0 if it grows at 1 N/m. Bit-identical each time. Real-time: never from the servo thread.
double stiffest(const RestedWall& wall);

}  // namespace thimble::studies
