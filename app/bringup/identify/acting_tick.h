#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstddef>

namespace thimble::bringup {

/// When a torque that was asked for at a tick acts: the middle of its tick at the motors, so many
/// whole ticks and a part of one later.
struct ActingTick {
  std::size_t whole = 0;
  double part = 0;

  /// Takes the delay of torques and the time between ticks, s.
  ActingTick(double delay, double dt) {
    const double ticks = delay / dt + 0.5;
    whole = static_cast<std::size_t>(std::floor(ticks));
    part = ticks - static_cast<double>(whole);
  }

  /// Returns what a quantity of ticks is then, for the torque asked for at tick `k`, `of(tick)`.
  template <class Of>
  Eigen::Vector3d then(std::size_t k, const Of& of) const {
    return (1 - part) * of(k + whole) + part * of(k + whole + 1);
  }
};

}  // namespace thimble::bringup
