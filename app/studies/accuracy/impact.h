#pragma once

#include <functional>

namespace thimble::studies {

/// A free mass that hits a sampled wall and leaves it again, without dry friction: the simplest
/// measure of a loop's latency [PHYSICS 1.5]. SI.
struct Impact {
  double mass = 0.075;     ///< kg [PHYSICS 0]
  double viscous = 0.005;  ///< N s/m
  double stiffness = 1000;
  double damping = 0;  ///< Of the wall, N s/m, by backward difference.
  double speed = 0.2;  ///< m/s
  double period = 0.001;
  double delay = 0;  ///< s
  /// Returns the duration (s) of the k-th tick of run `run`, if ticks are uneven; each at least 1
  /// us.
  std::function<double(int run, int k)> period_of = {};
};

/// Returns the mean ratio of the speeds after and before, over 200 phases of the contact within a
/// tick. Exact between events. Real-time: never from the servo thread.
double mean_restitution(const Impact& impact);

}  // namespace thimble::studies
