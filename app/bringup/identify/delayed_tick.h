#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

namespace thimble::bringup {

/// Tick in which a torque requested at another tick acts. It is the middle of the tick at the
/// motors: a number of whole ticks and a fraction later.
struct DelayedTick {
  std::size_t whole = 0;
  double part = 0;

  /// Takes the delay of torques and the time between ticks, s.
  DelayedTick(double delay, double dt) {
    const double ticks = delay / dt + 0.5;
    whole = static_cast<std::size_t>(std::floor(ticks));
    part = ticks - static_cast<double>(whole);
  }

  /// Returns the quantity `of(tick)`, interpolated at the time when the torque requested at tick
  /// `k` acts.
  template <class Of>
  Eigen::Vector3d then(std::size_t k, const Of& of) const {
    return (1 - part) * of(k + whole) + part * of(k + whole + 1);
  }
};

}  // namespace thimble::bringup
