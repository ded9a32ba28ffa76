#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

#include "ball/ball_feature.h"
#include "ball/ball_source.h"
#include "ball/ball_step.h"
#include "mesh/position_range.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// Finds the contact of a tip that is a ball: a `Contact` stage of ContactForceLaw.
///
/// The proxy is the centre of a ball that touches the solid at most. In each tick it moves to the
/// point closest to the tip that it can reach [RKK]. Each step leads within half-spaces whose
/// planes are farther than the radius from the solid, and no farther than these are known
/// (BallSource). So the proxy never enters, passes no part, however thin, and comes nearer to the
/// tip with each step. On edges and corners, which bend away from the ball, Newton's steps take
/// that into account; they end when the proxy rests against the parts that it touches.
///
/// Frame W, m. No length is compared with a constant in scene units.
template <BallSource Source>
class BallContact {
 public:
  /// Maximum number of steps per tick; the next tick continues. [chosen]
  static constexpr int kStepsMax = 32;

  explicit BallContact(Source source) : source_(std::move(source)) {}

  /// Finds the contact at `state.p_WT` (W, m) and keeps it until the next call.
  ///
  /// `p_WP` is the centre of the ball; `depth` is its distance from the tip. `triangle` is one that
  /// it touches. A tip that is inside on the first tick touches nothing until it has been outside.
  /// A position that is NaN or beyond `kPositionMax` ends the contact and makes the next tick a
  /// first one. Real-time: safe; a few ns far from the surface.
  const ContactState& update(const driver::DeviceState& state) noexcept {
    const Eigen::Vector3d& p_WT = state.p_WT;
    steps_ = 0;
    if (!within_range(p_WT)) [[unlikely]] {
      state_ = {};
      has_before_ = false;
    } else if (!has_before_ || began_inside_) [[unlikely]] {
      set_free(p_WT);
      began_inside_ = source_.inside(p_WT);
    } else if (!state_.touching && source_.clear(p_WQ_, p_WT)) {
      p_WQ_ = p_WT;
    } else {
      follow(p_WT);
    }
    p_WT_ = p_WT;
    return state_;
  }

  /// Begins contact on a part with the centre of the ball at `p_WP`, whatever the path of the tip:
  /// for a world of several objects (render/src/world). Real-time: safe.
  void begin(std::int32_t id, const Eigen::Vector3d& p_WP) noexcept {
    set_free(p_WP);
    p_WT_ = p_WP;
    held_[0] = source_.feature(id, p_WP);
    weight_[0] = 0;
    held_count_ = 1;
    state_.touching = true;
    state_.triangle = id;
    state_.n_W = held_[0].n_W;
    state_.p_WP = p_WP;
  }
  /// Ends the contact, if any, and places the free tip at `p_WT` (W, m). Real-time: safe.
  void set_free(const Eigen::Vector3d& p_WT) noexcept {
    state_ = {};
    held_count_ = 0;
    has_before_ = true;
    began_inside_ = false;
    p_WQ_ = p_WT;
  }

  /// Returns the result of the last `update`. Real-time: safe.
  const ContactState& state() const noexcept { return state_; }

  /// Returns the point of the surface that the ball touches, on the part that presses most, and
  /// its derivative by the tip (surface_response.h). Precondition: the last `update` touches.
  /// Real-time: safe.
  ClosestSurfacePoint closest(const Eigen::Vector3d&) const noexcept {
    const std::size_t main = main_part();
    return {.p_M = held_[main].p_W,
            .n_M = held_[main].n_W,
            .J_MT = held_[main].slide() * slide(),
            .fall_W = state_.n_W};
  }

  /// Returns the parts that hold the ball, none if it is free. Real-time: safe.
  std::span<const BallFeature> held() const noexcept { return {held_.data(), held_count_}; }
  /// Returns the number of steps of the last `update`. Real-time: safe.
  int steps() const noexcept { return steps_; }
  /// Returns the number of ticks that ended before the ball was at rest. Real-time: safe.
  std::uint64_t unsettled() const noexcept { return unsettled_; }

  Source& source() noexcept { return source_; }
  const Source& source() const noexcept { return source_; }
  /// Returns an object with `inside`, like the searches of meshes. Real-time: safe.
  const Source& search() const noexcept { return source_; }
  decltype(auto) mesh() const noexcept requires requires(const Source& source) { source.mesh(); }
  { return source_.mesh(); }

 private:
  // Largest share of the radius of curvature that the tip may be deep for Newton's steps: beyond
  // it the ball does not rest on an edge. [chosen]
  static constexpr double kBendMax = 0.97;
  // Newton's steps, and those without, in turn: so none of them repeats for ever. [chosen]
  static constexpr int kNewtonSteps = 12;
  static constexpr int kTurnSteps = 16;

  // Moves the ball to where it rests.
  void follow(const Eigen::Vector3d& p_WT) noexcept {
    const double radius = source_.radius(), rounding = source_.rounding();
    const std::int32_t before = state_.touching ? state_.triangle : -1;
    double want = (p_WT - p_WQ_).norm();
    // A ball that touches moves about as far as the tip.
    if (state_.touching) want = std::min(want, 2 * (p_WT - p_WT_).norm() + rounding);
    bool newton = true;
    for (int round = 0; round < kStepsMax; ++round) {
      ++steps_;
      double reach = want;
      const auto features = source_.features(p_WQ_, reach);
      const Eigen::Vector3d to_tip = p_WT - p_WQ_;
      const bool bends = newton && round % kTurnSteps < kNewtonSteps;
      const Eigen::Matrix3d H = bends ? bend(features) : Eigen::Matrix3d::Identity();
      // Around an edge or corner by at most 45 degrees.
      if (!H.isIdentity(0)) reach = std::min(reach, radius);
      BallStep step = ball_step(features, to_tip, H, rounding / 4);
      if (!step.feasible) {
        if (!bends) break;
        newton = false;
        continue;
      }
      const double length = step.y.norm();
      const bool cut = length > reach;
      if (cut) step.y *= reach / length * (1 - 0x1p-20);
      hold(features, step);
      if (!cut && step.count == 0) {
        set_free(p_WT);
        return;
      }
      p_WQ_ += step.y;
      if (cut) {
        // Without room for a step, another one would not move it.
        if (!(reach > rounding)) break;
        want = std::min(2 * want + rounding, (p_WT - p_WQ_).norm());
        continue;
      }
      // With H = 1 the step ends where the way to the tip is a combination of the normals.
      const bool exact = (H * step.y - step.y).norm() <= 4 * rounding;
      if (settled(radius, rounding) && exact) {
        touch(p_WT, before, true);
        return;
      }
    }
    ++unsettled_;
    touch(p_WT, before, false);
  }

  // Returns 1 minus the sum of the weights times the curvatures of the parts.
  Eigen::Matrix3d bend(std::span<const BallFeature> features) const noexcept {
    Eigen::Matrix3d H = Eigen::Matrix3d::Identity();
    double sum = 0;
    for (std::size_t i = 0; i < held_count_; ++i) {
      for (const BallFeature& feature : features) {
        if (feature.id != held_[i].id || feature.kind == BallFeature::Kind::kFace) continue;
        const double share = weight_[i] / (source_.radius() + feature.gap);
        sum += share * feature.bend_max();
        H -= share * feature.bend();
      }
    }
    // Of a ball that does not rest on these parts, only the direction counts.
    if (sum > kBendMax) H += (1 - kBendMax / sum) * (Eigen::Matrix3d::Identity() - H);
    return H;
  }

  void hold(std::span<const BallFeature> features, const BallStep& step) noexcept {
    held_count_ = step.count;
    for (std::size_t i = 0; i < step.count; ++i) {
      held_[i] = features[step.active[i]];
      weight_[i] = step.weight[i];
    }
  }

  // Returns whether the parts that hold the ball are the same where it is now, and updates them.
  bool settled(double radius, double rounding) noexcept {
    bool same = true;
    for (std::size_t i = 0; i < held_count_; ++i) {
      const BallFeature now = source_.feature(held_[i].id, p_WQ_);
      const double turned = (now.n_W - held_[i].n_W).norm();
      same = same && now.gap <= 4 * rounding &&
             turned * std::max(weight_[i], radius) <= 4 * rounding * (1 + weight_[i] / radius);
      held_[i] = now;
    }
    return same;
  }

  void touch(const Eigen::Vector3d& p_WT, std::int32_t before, bool settled) noexcept {
    const Eigen::Vector3d d = p_WQ_ - p_WT;
    const double depth = d.norm();
    Eigen::Vector3d n = d;
    // Near the surface the direction of d is rounding.
    if (held_count_ > 0 && !(depth > 1024 * source_.rounding())) {
      n = held_[0].n_W;
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (std::size_t i = 0; i < held_count_; ++i) sum += weight_[i] * held_[i].n_W;
      if (sum.squaredNorm() > 0) n = sum;
    }
    state_.touching = depth > 0;
    if (!state_.touching) {
      set_free(p_WT);
      return;
    }
    state_.n_W = settled && held_count_ == 1 ? held_[0].n_W : Eigen::Vector3d(n.normalized());
    state_.depth = std::max(0.0, state_.n_W.dot(d));
    state_.p_WP = p_WT + state_.depth * state_.n_W;
    if (held_count_ > 0) state_.triangle = held_[main_part()].id;
    state_.hops = before >= 0 && before != state_.triangle ? 1 : 0;
  }

  std::size_t main_part() const noexcept {
    return static_cast<std::size_t>(
        std::max_element(
            weight_.begin(),
            weight_.begin() + static_cast<std::ptrdiff_t>(std::max<std::size_t>(held_count_, 1))) -
        weight_.begin());
  }

  // Returns the derivative of the centre of the ball with respect to the tip.
  Eigen::Matrix3d slide() const noexcept {
    const Eigen::Vector3d& n = held_[0].n_W;
    if (held_count_ == 1) return Eigen::Matrix3d::Identity() - n * n.transpose();
    if (held_count_ > 2) return Eigen::Matrix3d::Zero();
    const Eigen::Vector3d along = n.cross(held_[1].n_W).normalized();
    return along * along.transpose();
  }

  Source source_;
  ContactState state_;
  std::array<BallFeature, 3> held_;  // that the ball touches
  std::array<double, 3> weight_{};   // their parts in the way from the tip to the ball, m
  std::size_t held_count_ = 0;
  Eigen::Vector3d p_WQ_{0, 0, 0};  // centre of the ball
  Eigen::Vector3d p_WT_{0, 0, 0};  // tip at the last tick
  bool has_before_ = false;
  bool began_inside_ = false;  // the tip has been inside since the first tick
  int steps_ = 0;
  std::uint64_t unsettled_ = 0;
};

}  // namespace thimble::render
