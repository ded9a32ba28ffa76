#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "thimble/render/contact_state.h"

namespace thimble::render {

/// Replaces a surface that is not loaded by the plane that was felt last. The plane begins at the
/// contact, so nothing jumps. When the surface is loaded, the felt contact fades over to it in
/// `kFadeTicks`. All Real-time: safe.
class HeldPlane {
 public:
  /// Fade time: 32 ms at 1 kHz, as long as the finest change that a hand follows.
  static constexpr int kFadeTicks = 32;

  /// Puts the contact at `p_WT` (W, m) on the plane. The first call of a hold takes the plane from
  /// `state` of the last tick. The depth is at least 0, because the end of the contact is not
  /// known. Once the tip has been above the plane, the depth stays 0. The plane is infinite, so a
  /// tip that goes around the object must not hit it in free air. The depth never exceeds twice the
  /// depth at the begin of the hold. Beyond that the plane gives way, because a surface that bends
  /// away would be felt as a wall.
  void hold(const Eigen::Vector3d& p_WT, ContactState& state) noexcept {
    if (left_ < kFadeTicks) {
      n_W_ = state.n_W;
      height_ = state.n_W.dot(state.p_WP);
      most_ = 2 * state.depth;
      lifted_ = false;
    }
    left_ = kFadeTicks;
    state.n_W = n_W_;
    state.depth = held_depth(p_WT);
    lifted_ = lifted_ || !(state.depth > 0);
    state.p_WP = p_WT + state.depth * n_W_;
  }

  /// Blends the contact at `p_WT` (W, m) from the plane to the surface in `state`. Direction and
  /// depth are blended together, so two opposite contacts pass through zero.
  void fade(const Eigen::Vector3d& p_WT, ContactState& state) noexcept {
    if (left_ == 0) return;
    --left_;
    const double share = static_cast<double>(left_) / kFadeTicks;
    const Eigen::Vector3d way =
        (1 - share) * state.depth * state.n_W + share * held_depth(p_WT) * n_W_;
    state.depth = way.norm();
    if (state.depth > 0) state.n_W = way / state.depth;
    state.p_WP = p_WT + state.depth * state.n_W;
  }

  /// Puts the contact at `p_WT` (W, m) on the fading plane if the surface reports no contact.
  /// Returns false once the plane has faded or the tip is above it: the contact has ended.
  bool fade_out(const Eigen::Vector3d& p_WT, ContactState& state) noexcept {
    if (left_ == 0) return false;
    --left_;
    const double depth = held_depth(p_WT);
    if (!(depth > 0) || left_ == 0) return false;
    state.n_W = n_W_;
    state.depth = depth * left_ / kFadeTicks;
    state.p_WP = p_WT + state.depth * n_W_;
    return true;
  }

  /// Returns whether the last tick was held.
  bool holding() const noexcept { return left_ == kFadeTicks; }
  /// Returns whether the plane is still felt.
  bool fading() const noexcept { return left_ > 0; }

  /// Forgets the plane: the contact has ended.
  void drop() noexcept { left_ = 0; }

 private:
  double held_depth(const Eigen::Vector3d& p_WT) noexcept {
    if (lifted_) return 0;
    const double depth = height_ - n_W_.dot(p_WT);
    if (depth > most_) height_ -= depth - most_;
    return std::clamp(depth, 0.0, most_);
  }

  bool lifted_ = false;  // whether the tip has been above the plane since the hold began
  int left_ = 0;         // remaining ticks of fading; kFadeTicks while held
  Eigen::Vector3d n_W_{0, 0, 0};
  double height_ = 0;  // n_W . p on the plane, m
  double most_ = 0;    // maximum depth, m
};

}  // namespace thimble::render
