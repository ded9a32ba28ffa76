#pragma once

#include <functional>
#include <memory>

#include "studies/accuracy/velocity_estimates.h"

namespace thimble::studies {

/// A wall that an arm rests against in a hand: a two-sided spring and a damper that are worked
/// out once per tick. The hand's damping is the arm's; its spring does not matter beside the
/// wall's.
struct RestedWall {
  double mass = 0.1;     ///< kg, of arm and hand [PHYSICS 0]
  double viscous = 3;    ///< N s/m, of arm and hand
  double damping = 0;    ///< N s/m, of the wall
  double period = 1e-3;  ///< s
  double delay = 0;      ///< s, from seeing a place to the force
  double duration = 1;   ///< s, of an oscillation; uneven ticks take longer to show their mean.
  /// Gives the length of tick k, s; if empty, all have `period`.
  std::function<double(int)> period_of = {};
  /// Makes the estimate of velocity for the damper; if empty, the difference over a tick.
  std::function<std::unique_ptr<VelocityEstimate>()> estimate = {};
};

/// Finds the largest stiffness at which an oscillation of 1 mm dies, N/m, by bisection to 0.1 %; 0
/// if it grows at 1 N/m. The same bits each time. Real-time: never from the servo thread.
double stiffest(const RestedWall& wall);

}  // namespace thimble::studies
