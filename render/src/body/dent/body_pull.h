#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

namespace thimble::render {

/// Lets the hand feel the pull of a dent's springs at the tip [BP 4.2, future work].
///
/// The pull is the gradient of the springs' energy (BendablePolygon::pull_at_tip), so a surface
/// that keeps its cells returns exactly the energy that it received. Where a tracker finds another
/// part of the surface, that energy jumps without work. An account prevents a gain: work of the
/// hand against the pull is added, work of the pull on the hand is subtracted. Where less than a
/// quarter of a spring's energy is left, the pull fades softly. A pull that is cut off when the
/// account is empty would return when the hand moves in again. This would be a switch with a limit
/// cycle of its full force.
///
/// On strokes the account never acts (dent_pull_test.cpp); under a random tremor of 0.03 mm per
/// tick it acts in one tick of a hundred. A force held for a tick lets a spring k do k x^2 / 2 more
/// work per move of x than it has energy [PHYSICS 1.1]. This amount is added to the account.
///
/// It never pulls into the surface, so that leaving does not stick.
class BodyPull {
 public:
  /// Lets the hand feel `share` (0 to 1) of the pull, for ticks of `step` s. Real-time: safe.
  BodyPull(double share, double step) noexcept : share_(share), step_(step) {}

  // All of the following are Real-time: safe.

  /// Returns the felt force (N in W) of the pull `f_T_W`. The tip is at `p_WT` (m), moves at `v_WT`
  /// (m/s), and is `depth` (m) below a surface with the unit normal `n_W`. NaN: none.
  Eigen::Vector3d force(const Eigen::Vector3d& f_T_W, const Eigen::Vector3d& p_WT,
                        const Eigen::Vector3d& v_WT, const Eigen::Vector3d& n_W,
                        double depth) noexcept {
    const double normal = f_T_W.dot(n_W);
    // Written so that NaN means no force.
    const bool pulls = normal > 0 && depth >= 0 && f_T_W.squaredNorm() < kForceMax * kForceMax;
    const double stiffness = pulls && depth > 0 ? share_ * normal / depth : 0;
    account(p_WT, v_WT.dot(n_W) * step_, n_W, stiffness, depth);
    sent_.setZero();
    if (!pulls) return sent_;
    // A spring holds F x / 2. Below a quarter of that the pull fades with the rest, so it is at
    // most eight times as stiff there as without fading. Dampers, whose force has no stored energy,
    // do not cause fading.
    const double quarter = 0.125 * share_ * normal * depth;
    const double left = std::max(stored_ + kLittle, 0.0);
    const double faded = left < quarter ? left / quarter : 1.0;
    sent_ = share_ * faded * f_T_W;
    const double next = v_WT.dot(n_W) * step_;
    const double given = sent_.dot(v_WT) * step_ - stiffness / 2 * next * next;
    const bool spent = !(given <= left);
    if (spent) sent_ *= given > 0 ? left / given : 0;
    if (faded < 1 || spent) ++limited_;
    return sent_;
  }
  /// Ends the touch. The stored energy stays with the surface, which dissipates it.
  void leave() noexcept {
    sent_.setZero();
    stored_ = 0;
    has_before_ = false;
  }
  /// Returns the energy that the hand has supplied and not received back since it touched, J.
  double stored() const noexcept { return stored_; }
  /// Returns the number of ticks in which the account has reduced the pull.
  std::uint64_t limited() const noexcept { return limited_; }

 private:
  static constexpr double kForceMax = 1e6;  // N; the same as in SpringMotion::push
  static constexpr double kHeldMax = 1;     // J; a hand cannot move so far in a tick
  static constexpr double kLittle = 5e-6;  // J, so that a touch can begin [chosen: 0.1 mm of 50 mN]

  // `way_out` is the tip's path along the normal by its speed, for the first tick.
  void account(const Eigen::Vector3d& p_WT, double way_out, const Eigen::Vector3d& n_W,
               double stiffness, double depth) noexcept {
    double along = std::clamp(way_out, -depth, depth);
    if (has_before_) {
      const Eigen::Vector3d way = p_WT - p_WT_before_;
      along = way.dot(n_W);
      stored_ -= sent_.dot(way);
    }
    const double held = stiffness / 2 * along * along;
    if (held < kHeldMax) stored_ += held;  // written so that NaN is not added
    p_WT_before_ = p_WT;
    has_before_ = true;
  }

  double share_;
  double step_;
  double stored_ = 0;
  Eigen::Vector3d sent_{0, 0, 0};
  Eigen::Vector3d p_WT_before_{0, 0, 0};
  bool has_before_ = false;
  std::uint64_t limited_ = 0;
};

}  // namespace thimble::render
