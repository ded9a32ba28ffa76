#pragma once

#include <Eigen/Core>
#include <algorithm>

namespace thimble::render {

/// Lets the hand feel how the springs of a dent pull at the cursor [BP 4.2, future work], without
/// ever giving it more energy than it has put in.
///
/// What the hand does against the pull is put by, what the pull does for the hand is taken from
/// that; where it is used up, as the springs' fading may do, the pull does not help the hand along.
/// It goes softly: a pull that is cut where the last of it is spent, and whole where the hand moves
/// in again, is a switch, and has a limit cycle of all of its force.
/// It never pulls into the surface, so that leaving does not stick. What is left to chance is the
/// move of one tick, as for every wall [STABILITY 1.6].
class BodyPull {
 public:
  /// Lets the hand feel `share` (0 to 1) of the pull, for ticks of `step` s. Real-time: safe.
  BodyPull(double share, double step) noexcept : share_(share), step_(step) {}

  // All of the following are Real-time: safe.

  /// Finds what the hand feels (N in W) of the pull `f_T_W`, with the tip at `p_WT` (m), going at
  /// `v_WT` (m/s), `depth` (m) below a surface whose unit normal is `n_W`. NaN: none.
  Eigen::Vector3d force(const Eigen::Vector3d& f_T_W, const Eigen::Vector3d& p_WT,
                        const Eigen::Vector3d& v_WT, const Eigen::Vector3d& n_W,
                        double depth) noexcept {
    account(p_WT);
    sent_.setZero();
    const double normal = f_T_W.dot(n_W);
    // Written so that NaN means no force.
    if (normal > 0 && depth >= 0 && f_T_W.squaredNorm() < kForceMax * kForceMax) {
      // A spring would hold F x / 2. Below half of that the pull fades with what is left, so it is
      // at most four times as stiff there as it is by itself.
      const double half = 0.25 * share_ * normal * depth;
      const double left = std::max(stored_, 0.0) + kLittle;
      sent_ = share_ * std::min(1.0, left / (half + kLittle)) * f_T_W;
      const double given = sent_.dot(v_WT) * step_;
      if (!(given <= stored_)) sent_ *= stored_ > 0 && given > 0 ? stored_ / given : 0;
    }
    return sent_;
  }
  /// Hears that the touch has ended: what is put by stays with the surface, which keeps it.
  void leave() noexcept {
    sent_.setZero();
    stored_ = 0;
    has_before_ = false;
  }
  /// Tells what the hand has put in and not got back since it touched, J.
  double stored() const noexcept { return stored_; }

 private:
  static constexpr double kForceMax = 1e6;  // N; as SpringMotion::push
  static constexpr double kLittle = 5e-6;  // J, so that a touch can begin [chosen: 0.1 mm of 50 mN]

  void account(const Eigen::Vector3d& p_WT) noexcept {
    if (has_before_) stored_ -= sent_.dot(p_WT - p_WT_before_);
    p_WT_before_ = p_WT;
    has_before_ = true;
  }

  double share_;
  double step_;
  double stored_ = 0;
  Eigen::Vector3d sent_{0, 0, 0};
  Eigen::Vector3d p_WT_before_{0, 0, 0};
  bool has_before_ = false;
};

}  // namespace thimble::render
