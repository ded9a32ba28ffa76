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
/// `steepest` is felt with that slope, and led back in the same way. An edge at which the slope of
/// the map turns by more than `bend` allows is spread too. On all other places the felt value is
/// that of the map, bit for bit.
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
      if (triangle != triangle_) {
        const Eigen::Vector3d before_W =
            limited(slope_of(sample(triangle_, closest.p_M)), limits.steepest);
        const Eigen::Vector3d turn = before_W - slope_W;
        const double size = turn.norm();
        const bool seam =
            !map.continues(triangle_, triangle, closest.p_M, (closest.p_M - p_M_).norm());
        if (seam || size > limits.bend * path + kRounding * limits.ramp) {
          const bool lagged = lags();
          r_W_ += turn;
          const double offset = std::abs(felt_.value - found.value);
          const double bend = limits.shortest > 0
                                  ? (4 * offset / limits.shortest + 2 * size) / limits.shortest
                                  : kUnlimited;
          finest_ = lagged ? std::max(finest_, bend) : bend;
        }
        stepped = stepped || seam;
      } else if (stepped && !lags()) {
        finest_ = kUnlimited;
      }
      drag(p_WT);
      if (stepped || lags()) {
        const double bend = std::min(finest_, limits.bend);
        steer(closest.fall_W, bend, path, limits.ramp);
        // By the mean of both slopes: exact up to the third order of the step.
        const double felt = felt_.value + (felt_.slope_W + slope_W + r_W_).dot(step) / 2;
        offset_ = felt - found.value;
        if (!stepped) end_if_small(bend, path, limits.ramp);
      }
      felt_ = {found.value, slope_W};
      if (lags()) add_rest(found.value);
    }
    apart_or_steep_ = apart || steep;
    p_WT_before_ = p_WT;
    p_M_ = closest.p_M;
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
  // What is left ends if the force then steps by less than it may in a few ticks. [chosen: with
  // the slope at which the rest would end by itself]
  static constexpr double kEndSteps = 3;

  static Eigen::Vector3d limited(const Eigen::Vector3d& slope_W, double steepest) noexcept {
    const double size = slope_W.norm();
    if (size > steepest) return steepest / size * slope_W;
    return slope_W;
  }

  // Drags a point behind the tip.
  void drag(const Eigen::Vector3d& p_WT) noexcept {
    const Eigen::Vector3d way = p_WT - p_W_trail_;
    const double length = way.norm();
    if (length > kTrail) p_W_trail_ += (1 - kTrail / length) * way;
    way_W_ = length > kTrail ? Eigen::Vector3d(way / length) : Eigen::Vector3d(way / kTrail);
  }

  // Turns r to the slope that leads the value back: as steep as it can be flattened in time again.
  void steer(const Eigen::Vector3d& n_W, double bend, double path, double ramp) noexcept {
    const Eigen::Vector3d along = way_W_ - way_W_.dot(n_W) * n_W;
    const double size = std::min(ramp, std::sqrt(bend * std::abs(offset_)));
    const Eigen::Vector3d turn = (offset_ > 0 ? -size : size) * along - r_W_;
    const double much = turn.norm();
    r_W_ += much > bend * path ? Eigen::Vector3d(bend * path / much * turn) : turn;
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
  Eigen::Vector3d p_WT_before_{0, 0, 0}, p_M_{0, 0, 0};
  Eigen::Vector3d p_W_trail_{0, 0, 0}, way_W_{0, 0, 0};
  // Felt value and slope minus those of the map; 0: none.
  double offset_ = 0;
  Eigen::Vector3d r_W_{0, 0, 0};
  double finest_ = 0;  // limit of the bend by the length of the step, 1/m^2
};

}  // namespace thimble::render
