#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "plant/axis_dynamics.h"

namespace thimble::support {

/// A sampled wall in one dimension: the plant's exact map, an encoder, a delayed and held force.
/// Free space is x > 0, and the wall's force is positive.
struct Wall {
  device_sim::PlantSettings plant{.mass = 0.075, .viscous = 0.005, .coulomb = 0};
  device_sim::HandSettings hand{};
  double stiffness = 1000;     ///< N/m
  double damping = 0;          ///< Of the wall, N s/m; never pulls.
  double encoder_step = 0;     ///< m; 0: none
  double velocity_corner = 0;  ///< Pole of the velocity estimate, Hz; 0: none.
  std::int64_t period_ns = 1'000'000;
  std::int64_t delay_ns = 0;
  bool two_sided = false;  ///< Also pulls on its far side, and sticks to the tip.
  double pull = 0;         ///< Constant force of the hand, N.
};

/// Runs one wall tick by tick. A Gate is called as `double gate(requested, x_read, v, dt)` and
/// returns the force that goes to the motor.
class WallRig {
 public:
  explicit WallRig(const Wall& wall)
      : wall_(wall),
        axis_(device_sim::AxisDynamics::make(wall.plant, wall.hand).value()),
        whole_(static_cast<std::size_t>(wall.delay_ns / wall.period_ns)),
        rest_ns_(wall.delay_ns % wall.period_ns),
        period_(static_cast<double>(wall.period_ns) * 1e-9) {
    if (wall.velocity_corner > 0) {
      gain_ = -std::expm1(-2 * std::numbers::pi * wall.velocity_corner * period_);
    }
  }

  device_sim::AxisState state;
  double anchor = 0;  ///< Target of the hand, m.

  /// Advances the time without a tick.
  void drift(std::int64_t ns) { move(0, ns); }

  /// Reads, computes the wall, advances by one period. Returns the sent force.
  double tick() {
    return tick([](double requested, double, double, double) { return requested; });
  }

  template <class Gate>
  double tick(Gate gate) {
    const double x = read(state.x);
    if (begun_) {
      velocity_ += gain_ * ((x - x_read_) / period_ - velocity_);
      x_before_ = x_read_;
    } else {
      x_before_ = x;
    }
    x_read_ = x;
    double requested = 0;
    if (wall_.two_sided) {
      requested = -wall_.stiffness * x - wall_.damping * velocity_;
    } else if (x < 0) {
      requested = std::max(0.0, -wall_.stiffness * x - wall_.damping * velocity_);
    }
    const double sent = gate(requested, x, velocity_, begun_ ? period_ : 0);
    begun_ = true;
    forces_[ticks_ % forces_.size()] = sent;
    const double now = late(whole_), before = late(whole_ + 1);
    ++ticks_;
    move(before, rest_ns_);
    move(now, wall_.period_ns - rest_ns_);
    return sent;
  }

  /// Returns the motion since the previous tick, as read.
  double way() const { return x_read_ - x_before_; }
  /// Returns the true work of the motor on the tip, J.
  double work() const { return work_; }
  double velocity() const { return velocity_; }

 private:
  double read(double x) const {
    return wall_.encoder_step > 0 ? wall_.encoder_step * std::round(x / wall_.encoder_step) : x;
  }
  double late(std::size_t ticks) const {
    return ticks > ticks_ ? 0 : forces_[(ticks_ - ticks) % forces_.size()];
  }
  void move(double force, std::int64_t ns) {
    const double before = state.x;
    axis_.step(state, {.force = force + wall_.pull, .anchor = anchor}, ns);
    work_ += force * (state.x - before);
  }

  Wall wall_;
  device_sim::AxisDynamics axis_;
  std::size_t whole_;
  std::int64_t rest_ns_;
  double period_;
  double gain_ = 1;
  std::array<double, 32> forces_{};
  std::size_t ticks_ = 0;
  double x_read_ = 0, x_before_ = 0, velocity_ = 0, work_ = 0;
  bool begun_ = false;
};

}  // namespace thimble::support
