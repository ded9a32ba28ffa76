#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "body/motion/body_motions.h"

namespace thimble::render {

/// A body that several hands touch in one run. Each hand has its own contact with it; their pushes
/// in a tick add up until the code that runs the loop advances the body, once.
class SharedBody {
 public:
  SharedBody() = default;
  SharedBody(const SharedBody&) = delete;
  SharedBody& operator=(const SharedBody&) = delete;
  virtual ~SharedBody() = default;

  /// Advances by `step` s under the pushes of all hands since the last step. Real-time: safe.
  virtual void step(double step) noexcept = 0;
  /// Returns the momentum, kg m/s, in the body's own time. Real-time: safe.
  virtual Eigen::Vector3d momentum_W() const noexcept = 0;
  /// Returns the angular momentum about the centre, kg m^2/s, in the body's own time; zero for a
  /// body that does not turn. Real-time: safe.
  virtual Eigen::Vector3d angular_momentum_W() const noexcept = 0;
};

/// A SharedBody with one kind of motion (BodyMotion).
template <class Motion>
class SharedBodyOf final : public SharedBody {
 public:
  explicit SharedBodyOf(Motion motion) : motion_(std::move(motion)) {}

  /// Adds a hand; returns its number. Real-time: never from the servo thread.
  std::size_t join() {
    hands_.emplace_back();
    first_ = motion_.energy();
    return hands_.size() - 1;
  }
  /// Pushes by this hand with `f_W` (N) at `p_W` (m) during the next step, once per step.
  /// Real-time: safe.
  void push(std::size_t hand, const Eigen::Vector3d& f_W, const Eigen::Vector3d& p_W) noexcept {
    motion_.push(f_W, p_W);
    hands_[hand].f_W = f_W;
    hands_[hand].p_W = p_W;
  }
  /// Returns the stored energy of a hand (J). A fall of it is energy that the body gave to this
  /// hand.
  ///
  /// Let E be the energy of motion and height, and E_0 its first value. W_i is the work of hand i
  /// on the body, and L = E_0 + sum W_i - E the loss of the body. The stored energy of hand i is
  ///
  ///     S_i = E - sum of W_j of the other hands + max L = E_0 + W_i + (max L - L).
  ///
  /// Without a loss this is E less the work of the other hands. A loss of the body belongs to no
  /// hand. Without the last term it would be a fall of all S_i. Then one hand's drag over a table
  /// would pay for a wrong force on another hand. Energy that a body gains without work lets L fall
  /// below its maximum and raises S_i, as with one hand. So the energy that all hands receive by
  /// falls of S_i is the energy that they supplied. Real-time: safe.
  double energy_for(std::size_t hand) const noexcept {
    double energy = motion_.energy() + lost_;
    for (std::size_t i = 0; i < hands_.size(); ++i) {
      if (i != hand) energy -= hands_[i].given;
    }
    return energy;
  }

  void step(double step) noexcept override {
    for (Hand& hand : hands_) hand.power = hand.f_W.dot(motion_.velocity_at(hand.p_W));
    motion_.step(step);
    double lost = first_ - motion_.energy();
    for (Hand& hand : hands_) {
      // A force held over the step does work by the mean velocity.
      hand.given += step / 2 * (hand.power + hand.f_W.dot(motion_.velocity_at(hand.p_W)));
      hand.f_W.setZero();
      lost += hand.given;
    }
    lost_ = std::max(lost_, lost);
  }
  Eigen::Vector3d momentum_W() const noexcept override { return motion_.body().momentum_W(); }
  Eigen::Vector3d angular_momentum_W() const noexcept override {
    if constexpr (requires { motion_.body().angular_momentum_W(); }) {
      return motion_.body().angular_momentum_W();
    } else {
      return Eigen::Vector3d::Zero();
    }
  }

  Motion& motion() noexcept { return motion_; }
  const Motion& motion() const noexcept { return motion_; }

 private:
  /// Push of a hand in this tick, and its work.
  struct Hand {
    Eigen::Vector3d f_W{0, 0, 0};
    Eigen::Vector3d p_W{0, 0, 0};
    double power = 0;  // W, before the step
    double given = 0;  // J
  };

  Motion motion_;
  std::vector<Hand> hands_;
  double first_ = 0;  // energy before any step, J
  double lost_ = 0;   // largest loss of energy so far, J
};

/// One hand's side of a SharedBody, as a BodyMotion. Its `step` does nothing: a hand's tick does
/// not move the body, so all hands of a tick find it at the same place.
///
/// `gain_at` assumes that every hand gives the same impulse at the same point. Then the share in
/// MovingTouch and HeldTouch (shared_force) is stable for any number of hands. The body's step by
/// all forces together gains at most the number of hands times the gain by one (Cauchy and
/// Schwarz). So the springs' energy falls as with one hand. All of it is Real-time: safe.
template <class Motion>
class SharedMotion {
 public:
  /// Joins the body as one of `hands`. Real-time: never from the servo thread.
  SharedMotion(std::shared_ptr<SharedBodyOf<Motion>> body, std::size_t hands)
      : body_(std::move(body)), hand_(body_->join()), hands_(static_cast<double>(hands)) {}

  Eigen::Matrix3d R_WB() const noexcept { return body_->motion().R_WB(); }
  Eigen::Vector3d p_WB() const noexcept { return body_->motion().p_WB(); }
  BodyFrame frame_after(double time) const noexcept { return body_->motion().frame_after(time); }
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& p_W) const noexcept {
    return body_->motion().velocity_at(p_W);
  }
  Eigen::Vector3d gain_at(const Eigen::Vector3d& p_W,
                          const Eigen::Vector3d& impulse) const noexcept {
    return hands_ * body_->motion().gain_at(p_W, impulse);
  }
  void push(const Eigen::Vector3d& f_W, const Eigen::Vector3d& p_W) noexcept {
    body_->push(hand_, f_W, p_W);
  }
  double energy() const noexcept { return body_->energy_for(hand_); }
  void step(double) noexcept {}

 private:
  std::shared_ptr<SharedBodyOf<Motion>> body_;
  std::size_t hand_;
  double hands_;
};

}  // namespace thimble::render
