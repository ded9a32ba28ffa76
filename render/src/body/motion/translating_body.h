#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "body/spring/oscillator.h"

namespace thimble::render {

/// A body that moves but does not turn: all base points relative to one mass point [BP 4.3]. Exact
/// under forces held over a step, with damping, so it cannot diverge.
class TranslatingBody {
 public:
  /// Makes a body of `mass` kg (> 0) at rest at 0, with `damping` N s/m (>= 0). `time_scale` (> 0)
  /// is the body's time over ours. A smaller one feels heavier, as 1 / time_scale^2 times the mass,
  /// and as if in a viscous liquid. With invalid numbers it does not move. Steps of `step` s.
  TranslatingBody(double mass, double damping, double time_scale, double step) noexcept
      : flow_(OscillatorStep::of(mass, 0, damping, time_scale * step)),
        mass_(mass),
        time_scale_(time_scale) {}

  // All of the following are Real-time: safe.

  /// Pushes by `f_W` (N), the reaction force of the hand, during the next step. A force that is NaN
  /// or beyond 10^6 N is ignored.
  void push(const Eigen::Vector3d& f_W) noexcept {
    constexpr double kForceMax = 1e6;  // N; no arm pushes harder
    if (f_W.squaredNorm() <= kForceMax * kForceMax) f_W_ += f_W;
  }
  /// Sets the velocity (m/s, the body's own time).
  void set_velocity(const Eigen::Vector3d& v_W) noexcept { v_W_ = v_W; }
  /// Advances by one step under the pushes, which are then cleared.
  void step() noexcept {
    flow_.apply(p_W_, v_W_, f_W_);
    f_W_.setZero();
  }

  /// Advances by one step like `step`, above a floor n . p >= height (`n_W` unit; m) with Coulomb
  /// friction of the coefficient `friction` (>= 0) and without rebound.
  ///
  /// The floor's impulse is given in two parts, one before the body moves and one after. The first
  /// counters the motion that the forces of the step would cause. So a body at rest stays in place,
  /// to rounding, and sliding slows down by friction times gravity. In each part friction is
  /// bounded by the normal impulse of that part.
  void step_on_floor(const Eigen::Vector3d& n_W, double height, double friction) noexcept {
    const double time = flow_.xv;  // s; displacement in a step per velocity
    // Written so that NaN, and a body that does not move, have no floor.
    const bool moves = time > 0;
    if (moves) {
      // Mean velocity of this step.
      const Eigen::Vector3d mean = v_W_ + flow_.xf / time * f_W_;
      v_W_ += floor_kick(n_W, (n_W.dot(p_W_) - height) / time, friction, mean);
    }
    step();
    if (!moves) return;
    p_W_ += std::max(height - n_W.dot(p_W_), 0.0) * n_W;
    v_W_ += floor_kick(n_W, (n_W.dot(p_W_) - height) / time, friction, v_W_);
  }

  /// Keeps the body where n . p >= height (`n_W` unit; m): moves it back and removes the outward
  /// velocity. Energy only falls.
  void keep_above(const Eigen::Vector3d& n_W, double height) noexcept {
    const double below = height - n_W.dot(p_W_);
    // Written so that NaN moves nothing.
    if (!(below > 0)) return;
    p_W_ += below * n_W;
    v_W_ += std::max(-n_W.dot(v_W_), 0.0) * n_W;
  }

  /// Returns the velocity, m/s, in our time.
  Eigen::Vector3d velocity() const noexcept { return time_scale_ * v_W_; }
  /// Returns the velocity gained per impulse, 1/kg, in our time. Real-time: safe.
  double gain() const noexcept { return time_scale_ * time_scale_ / mass_; }

  /// Returns the displacement of all base points, m; the velocity (m/s) and momentum (kg m/s) are
  /// in the body's own time.
  const Eigen::Vector3d& p_W() const noexcept { return p_W_; }
  const Eigen::Vector3d& v_W() const noexcept { return v_W_; }
  Eigen::Vector3d momentum_W() const noexcept { return mass_ * v_W_; }
  /// Returns the energy of motion, J: the work done at our velocity. Real-time: safe.
  double kinetic_energy() const noexcept { return mass_ / 2 * v_W_.squaredNorm(); }

 private:
  // Returns the change of velocity (m/s) by which a floor limits `v_W` to an approach of `allowed`
  // m/s, and along the floor as far as friction can.
  static Eigen::Vector3d floor_kick(const Eigen::Vector3d& n_W, double allowed, double friction,
                                    const Eigen::Vector3d& v_W) noexcept {
    const double into = n_W.dot(v_W);
    const double normal = -std::max(allowed, 0.0) - into;
    // Written so that NaN gives nothing.
    if (!(normal > 0)) return Eigen::Vector3d::Zero();
    const Eigen::Vector3d slip = v_W - into * n_W;
    const double fast = slip.norm();
    const double stopped = fast > 0 ? std::min(1.0, friction * normal / fast) : 0;
    return normal * n_W - stopped * slip;
  }

  OscillatorStep flow_;
  double mass_;
  double time_scale_;
  Eigen::Vector3d p_W_{0, 0, 0};
  Eigen::Vector3d v_W_{0, 0, 0};
  Eigen::Vector3d f_W_{0, 0, 0};
};

}  // namespace thimble::render
