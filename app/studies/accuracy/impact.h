#pragma once

#include <functional>

namespace thimble::studies {

/// A free mass that flies into a sampled wall and out again, without dry friction: the cheapest
/// look at what a loop's time does [PHYSICS 1.5]. SI.
struct Impact {
  double mass = 0.075;     ///< kg [PHYSICS 0]
  double viscous = 0.005;  ///< N s/m
  double stiffness = 1000;
  double damping = 0;  ///< Of the wall, N s/m, by backward difference.
  double speed = 0.2;  ///< m/s
  double period = 0.001;
  double delay = 0;  ///< s
  /// Gives the time (s) of the k-th tick of a run with this number, if ticks are not even; each at
  /// least 1 us.
  std::function<double(int run, int k)> period_of = {};
};

/// Finds the mean ratio of the speeds after and before, over 200 phases between the ticks and the
/// moment of contact. Exact between events. Real-time: never from the servo thread.
double mean_restitution(const Impact& impact);

}  // namespace thimble::studies
