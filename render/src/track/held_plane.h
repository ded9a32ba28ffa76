#pragma once

#include <Eigen/Core>
#include <algorithm>

#include "thimble/render/contact_state.h"

namespace thimble::render {

/// Stands in for a surface that is not known for a while: the plane that was felt last. It begins
/// where the contact was, so nothing jumps, and when the surface is known again the felt one fades
/// over to it in `kFadeTicks`. All Real-time: safe.
class HeldPlane {
 public:
  /// How long the plane fades: 32 ms at 1 kHz, as long as the finest change that a hand follows.
  static constexpr int kFadeTicks = 32;

  /// Puts the contact at `p_WT` (W, m) on the plane; the first call of a hold takes the plane from
  /// `state`, that of the last tick. The depth is at least 0: nobody knows that the contact ended.
  /// Once the tip has come above the plane it stays 0: a plane has no end, and who goes round the
  /// object must not run into it in free air. And it never exceeds twice the depth that the hold
  /// began with: beyond, the plane gives way, for a surface that bends away would be felt as a
  /// wall.
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

  /// Turns what is felt at `p_WT` (W, m) from the plane towards the surface, which `state` tells:
  /// direction and depth together, so that two that face each other pass by zero.
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

  /// Puts the contact at `p_WT` (W, m) on the fading plane where the surface says that there is
  /// none; false once the plane has faded or the tip is above it: the contact has ended.
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
  int left_ = 0;         // ticks of fading to come; kFadeTicks while held
  Eigen::Vector3d n_W_{0, 0, 0};
  double height_ = 0;  // n_W . p on the plane, m
  double most_ = 0;    // depth at most, m
};

}  // namespace thimble::render
