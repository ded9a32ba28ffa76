#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

#include "surface/map/surface_map.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// Value of a map as felt during one contact: neither it nor its slope steps.
///
/// A map steps at a seam of its texture coordinates, next to a triangle without a value, and where
/// the closest point jumps. There the felt value x stays, with its slope, and is then led back to
/// the map by an additional slope r. So dx = (slope of the map + r) . dp along the path of the tip
/// p. r points along the last path of the tip over the surface, whatever its direction. Its size
/// is at most `ramp`, and it changes by at most `bend` times the path. A map that is steeper than
/// `steepest` is felt with that slope, and led back in the same way. Where the slope turns by more
/// than `bend` allows, at an edge or where the closest point comes to one, that is spread too. On
/// all other places the felt value is that of the map, bit for bit.
///
/// A force that is minus the gradient of an energy U(x, depth), with the slope that is returned,
/// does no net work on any path that returns to the same felt value and depth. All functions are
/// Real-time: safe.
class MapFollower {
 public:
  /// Felt value and its gradient.
  struct Felt {
    double value = 1;                  ///< 0 to 1
    Eigen::Vector3d slope_W{0, 0, 0};  ///< By the position of the tip, 1/m.
  };

  /// Limits of the felt slope.
  struct Limits {
    double ramp = 0;                                            ///< Of r, 1/m, > 0.
    double bend = 0;                                            ///< Of dr/dp, 1/m^2, > 0.
    double steepest = std::numeric_limits<double>::infinity();  ///< Of the map, 1/m, > 0.
    double shortest = 0;  ///< Path over which a step is spread at least, m.
  };

  /// Returns the felt value for a tip at `p_WT` (m) with the closest point `closest` on
  /// `triangle`. `sample(triangle, p_M)` returns the quantity that is followed, a function of
  /// `map`; `found` is that at the closest point. NaN gives NaN.
  template <class Sample>
  Felt follow(const Eigen::Vector3d& p_WT, const ClosestSurfacePoint& closest,
              std::int32_t triangle, const SurfaceMap::Sample& found, const SurfaceMap& map,
              const Sample& sample, const Limits& limits) noexcept {
    const auto slope_of = [&](const SurfaceMap::Sample& at) {
      return closest.slope_at_tip(at.slope_M);
    };
    const Eigen::Vector3d raw_W = slope_of(found);
    const Eigen::Vector3d slope_W = limited(raw_W, limits.steepest);
    // The closest point does not follow the tip: it rests in a corner, or it has jumped.
    const bool apart = closest.J_MT.isZero(0);
    const bool steep = raw_W.squaredNorm() > limits.steepest * limits.steepest;
    // Written so that NaN is no contact.
    if (!touching_ || !(std::abs(felt_.value) <= 1)) {
      touching_ = true;
      offset_ = 0;
      r_W_.setZero();
      p_W_trail_ = p_WT;
      way_W_.setZero();
      felt_ = {found.value, slope_W};
    } else {
      const Eigen::Vector3d step = p_WT - p_WT_before_;
      const double path = step.norm();
      bool stepped = apart || steep || apart_or_steep_;
      // The closest point comes to an edge or leaves it, or jumps.
      const bool bent = (closest.J_MT - J_MT_).squaredNorm() > kBentMin;
      if (bent || triangle != triangle_) {
        const bool seam = triangle != triangle_ && !map.continues(triangle_, triangle, closest.p_M,
                                                                  (closest.p_M - p_M_).norm());
        const Eigen::Vector3d turn =
            (bent ? map_slope_W_
                  : limited(slope_of(sample(triangle_, closest.p_M)), limits.steepest)) -
            slope_W;
        const double size = turn.norm();
        if (seam || size > limits.bend * path + kRounding * limits.ramp) {
          if (!lags()) finest_ = 0;
          r_W_ += turn;
          spread_turn(size, limits.shortest);
        }
        stepped = stepped || seam;
      }
      if (stepped && !lags()) finest_ = 0;
      drag(p_WT);
      if (stepped || lags()) {
        const double bend = std::min(finest_, limits.bend);
        steer(closest.fall_W, bend, path, limits.ramp, apart);
        // By the mean of both slopes: exact up to the third order of the step.
        const double felt = felt_.value + (felt_.slope_W + slope_W + r_W_).dot(step) / 2;
        offset_ = felt - found.value;
        if (stepped) spread_step(std::abs(offset_), limits.shortest);
        if (!stepped) end_if_small(bend, path, limits.ramp);
      }
      felt_ = {found.value, slope_W};
      if (lags()) add_rest(found.value);
    }
    apart_or_steep_ = apart || steep;
    p_WT_before_ = p_WT;
    p_M_ = closest.p_M;
    J_MT_ = closest.J_MT;
    map_slope_W_ = slope_W;
    triangle_ = triangle;
    return felt_;
  }

  /// Ends the contact: the next one begins with the value of the map.
  void leave() noexcept { touching_ = false; }

  /// Returns whether the felt value differs from that of the map.
  bool lags() const noexcept { return offset_ != 0 || !r_W_.isZero(0); }

 private:
  static constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  static constexpr double kRounding = 1e-9;  // [chosen: 10^6 roundings of a value]
  // Length over which the direction of the tip is taken, m: some steps of an encoder [PHYSICS 0].
  static constexpr double kTrail = 0.0002;
  // Squared change of J from which it is a step. [chosen: from a face to an edge it is 1]
  static constexpr double kBentMin = 0.25;
  // Cosine of the angle between r and its goal from which it turns faster, and how much. [chosen:
  // 37 degrees; the force then changes by at most 3 times stiffness times path, below the 5 of
  // no_jumps.md]
  static constexpr double kAstray = 0.8, kTurnFaster = 3;
  // What is left ends if the force then steps by less than it may in a few ticks. [chosen: with
  // the slope at which the rest would end by itself]
  static constexpr double kEndSteps = 3;

  static Eigen::Vector3d limited(const Eigen::Vector3d& slope_W, double steepest) noexcept {
    const double size = slope_W.norm();
    if (size > steepest) return steepest / size * slope_W;
    return slope_W;
  }

  // Allow a bend that spreads a change of the slope, or of the value, over the path `shortest`.
  void spread_turn(double slope, double shortest) noexcept {
    finest_ = shortest > 0 ? std::max(finest_, 2 * slope / shortest) : kUnlimited;
  }
  void spread_step(double value, double shortest) noexcept {
    finest_ = shortest > 0 ? std::max(finest_, 4 * value / (shortest * shortest)) : kUnlimited;
  }

  // Drags a point behind the tip.
  void drag(const Eigen::Vector3d& p_WT) noexcept {
    const Eigen::Vector3d way = p_WT - p_W_trail_;
    const double length = way.norm();
    if (length > kTrail) p_W_trail_ += (1 - kTrail / length) * way;
    way_W_ = length > kTrail ? Eigen::Vector3d(way / length) : Eigen::Vector3d(way / kTrail);
  }

  // Turns r to the slope that leads the value back: as steep as it can be flattened in time again.
  // It grows slowly and turns quickly: else it would always come too late for a tip that moves to
  // and fro, or in small circles.
  void steer(const Eigen::Vector3d& n_W, double bend, double path, double ramp,
             bool apart) noexcept {
    const Eigen::Vector3d along = way_W_ - way_W_.dot(n_W) * n_W;
    const double size = std::min(ramp, std::sqrt(bend * std::abs(offset_)));
    const Eigen::Vector3d target = (offset_ > 0 ? -size : size) * along;
    const Eigen::Vector3d turn = target - r_W_;
    const bool astray = !apart && r_W_.dot(target) < kAstray * r_W_.norm() * target.norm();
    const double reach = (astray ? kTurnFaster : 1) * bend * path;
    const double much = turn.norm();
    r_W_ += much > reach ? Eigen::Vector3d(reach / much * turn) : turn;
  }

  void end_if_small(double bend, double path, double ramp) noexcept {
    const bool small = std::abs(offset_) <= kEndSteps * bend * path * path + kRounding &&
                       r_W_.norm() <= kEndSteps * bend * path + kRounding * ramp;
    if (!small) return;
    offset_ = 0;
    r_W_.setZero();
  }

  void add_rest(double found) noexcept {
    felt_.value += offset_;
    felt_.slope_W += r_W_;
    if (felt_.value >= 0 && felt_.value <= 1) return;
    // At the end of the range it does not change any more.
    felt_.value = std::clamp(felt_.value, 0.0, 1.0);
    offset_ = felt_.value - found;
    r_W_ -= felt_.slope_W;
    felt_.slope_W.setZero();
  }

  bool touching_ = false;
  // At the last tick.
  Felt felt_;
  bool apart_or_steep_ = false;
  std::int32_t triangle_ = -1;
  Eigen::Matrix3d J_MT_ = Eigen::Matrix3d::Zero();
  Eigen::Vector3d map_slope_W_{0, 0, 0};
  Eigen::Vector3d p_WT_before_{0, 0, 0}, p_M_{0, 0, 0};
  Eigen::Vector3d p_W_trail_{0, 0, 0}, way_W_{0, 0, 0};
  // Felt value and slope minus those of the map; 0: none.
  double offset_ = 0;
  Eigen::Vector3d r_W_{0, 0, 0};
  double finest_ = 0;  // bend that a step of the shortest path has, 1/m^2
};

}  // namespace thimble::render
