#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>

#include "surface/map/surface_map.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// Value of a map as felt during one contact: it never steps.
///
/// A map is not continuous at a seam of its texture coordinates, next to a triangle without a
/// value, and where the closest point jumps. There the felt value x stays, and its distance from
/// the map then vanishes over a ramp: a smooth step over the path along the direction in which the
/// tip moved, of the length at which its slope is `ramp`. A map that is steeper than `steepest` is
/// felt with that slope, and with a ramp behind it. On all other places the felt value is that of
/// the map, bit for bit.
///
/// Everywhere dx = slope . dp along the path of the tip p, with the slope that is returned. So a
/// force that is minus the gradient of an energy U(x, depth), with that slope, does no net work on
/// any path that returns to the same felt value and depth. All functions are Real-time: safe.
class MapFollower {
 public:
  /// Felt value and its gradient.
  struct Felt {
    double value = 1;                  ///< 0 to 1
    Eigen::Vector3d slope_W{0, 0, 0};  ///< By the position of the tip, 1/m.
  };

  /// Limits of the felt slope, 1/m, > 0.
  struct Limits {
    double ramp = 0;                                            ///< Of a ramp.
    double steepest = std::numeric_limits<double>::infinity();  ///< Of the map.
  };

  /// Returns the felt value for a tip at `p_WT` (m) with the closest point `closest`, where the map
  /// has the value `found`. `slope_max` is a bound of the map's gradient. NaN gives NaN.
  Felt follow(const Eigen::Vector3d& p_WT, const ClosestSurfacePoint& closest,
              const SurfaceMap::Sample& found, double slope_max, const Limits& limits) noexcept {
    const Eigen::Vector3d raw_W = closest.slope_at_tip(found.slope_M);
    const double size = raw_W.norm();
    const bool steep = size > limits.steepest;
    Eigen::Vector3d slope_W = steep ? Eigen::Vector3d(limits.steepest / size * raw_W) : raw_W;
    // Written so that NaN is no contact.
    if (!touching_ || !(std::abs(felt_.value) <= 1)) {
      touching_ = true;
      offset_ = 0;
      p_W_trail_ = p_WT;
    } else {
      drag(p_WT);
      const double reach = slope_max * (closest.p_M - p_M_).norm() * (1 + kRounding) + kRounding;
      if (!(std::abs(found.value - map_value_) <= reach)) {
        start(felt_.value - found.value, p_WT, closest.fall_W, limits);
      } else if (steep) {
        const double felt = felt_.value + (slope_W + felt_.slope_W).dot(p_WT - p_WT_before_) / 2;
        const double valid = std::clamp(felt, 0.0, 1.0);
        start(valid - found.value, p_WT, closest.fall_W, limits);
        // At the end of the range it does not change any more.
        if (valid != felt) slope_W.setZero();
      } else if (offset_ != 0 &&
                 (along_W_.isZero() || 1.5 * std::abs(offset_) > 2 * limits.ramp * length_)) {
        // It waits for a direction, or the limit has fallen, as under a tip that presses harder.
        start(felt_.value - map_value_, p_WT, closest.fall_W, limits);
      }
    }
    p_WT_before_ = p_WT;
    p_M_ = closest.p_M;
    map_value_ = found.value;
    felt_ = {found.value, slope_W};
    if (offset_ != 0) add_ramp(p_WT);
    return felt_;
  }

  /// Ends the contact: the next one begins with the value of the map.
  void leave() noexcept { touching_ = false; }

  /// Returns whether the felt value differs from that of the map.
  bool lags() const noexcept { return touching_ && offset_ != 0; }

 private:
  static constexpr double kRounding = 1e-9;  // [chosen: 10^6 roundings of a value]
  // Length over which the direction of the tip is taken, m: some steps of an encoder [PHYSICS 0].
  static constexpr double kTrail = 0.0002;

  // Drags a point behind the tip.
  void drag(const Eigen::Vector3d& p_WT) noexcept {
    const Eigen::Vector3d way = p_WT - p_W_trail_;
    const double length = way.norm();
    if (length > kTrail) p_W_trail_ += (1 - kTrail / length) * way;
  }

  // Begins a ramp at the tip.
  void start(double offset, const Eigen::Vector3d& p_WT, const Eigen::Vector3d& n_W,
             const Limits& limits) noexcept {
    offset_ = std::abs(offset) > kRounding ? offset : 0;
    const Eigen::Vector3d way = p_WT - p_W_trail_;
    const Eigen::Vector3d along = way - way.dot(n_W) * n_W;
    const double length = along.norm();
    // A tip that only presses has no direction yet; the ramp waits for one.
    along_W_ = length > kRounding * kTrail ? Eigen::Vector3d(along / length)
                                           : Eigen::Vector3d(Eigen::Vector3d::Zero());
    p_W_start_ = p_WT;
    // A smooth step is steepest in its middle, by a factor of 3/2.
    length_ = 1.5 * std::abs(offset_) / limits.ramp;
  }

  void add_ramp(const Eigen::Vector3d& p_WT) noexcept {
    const double t = along_W_.dot(p_WT - p_W_start_) / length_;
    if (t >= 1) {
      offset_ = 0;
      return;
    }
    double left = 1;
    if (t > 0) {
      left = 1 - t * t * (3 - 2 * t);
      felt_.slope_W -= offset_ * (6 * t * (1 - t) / length_) * along_W_;
    }
    felt_.value += left * offset_;
    if (felt_.value >= 0 && felt_.value <= 1) return;
    felt_.value = std::clamp(felt_.value, 0.0, 1.0);
    felt_.slope_W.setZero();
  }

  bool touching_ = false;
  // At the last tick.
  Felt felt_;
  double map_value_ = 1;
  Eigen::Vector3d p_WT_before_{0, 0, 0}, p_M_{0, 0, 0}, p_W_trail_{0, 0, 0};
  // Of the ramp.
  double offset_ = 0;  // felt value minus that of the map where it began; 0: none
  double length_ = 1;  // m
  Eigen::Vector3d p_W_start_{0, 0, 0}, along_W_{0, 0, 0};
};

}  // namespace thimble::render
