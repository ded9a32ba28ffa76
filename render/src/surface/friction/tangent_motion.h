#pragma once

#include <Eigen/Core>
#include <cmath>

#include "thimble/driver/device_state.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// Shortens `v` to the length `limit` if it is longer. A limit not above zero and a vector that is
/// not finite give zero. Real-time: safe.
inline Eigen::Vector3d shortened(const Eigen::Vector3d& v, double limit) noexcept {
  const double length2 = v.squaredNorm();
  // Written so that NaN gives zero.
  if (!(limit > 0) || !(length2 < HUGE_VAL)) return Eigen::Vector3d::Zero();
  return length2 > limit * limit ? Eigen::Vector3d(limit / std::sqrt(length2) * v) : v;
}

/// Returns the direction of `v`, or zero if it has none or is not finite. Real-time: safe.
inline Eigen::Vector3d direction_of(const Eigen::Vector3d& v) noexcept {
  const double length2 = v.squaredNorm();
  if (!(length2 > 0) || !(length2 < HUGE_VAL)) return Eigen::Vector3d::Zero();
  return v / std::sqrt(length2);
}

/// Input of a friction law in one tick of contact.
struct SlideTick {
  Eigen::Vector3d n_W{0, 0, 1};   ///< Outward unit normal.
  Eigen::Vector3d slip{0, 0, 0};  ///< Path along the surface since the last tick, m in W.
  double load = 0;                ///< Force of the surface along n_W, N, >= 0.
  double depth = 0;               ///< Depth as felt, m.
  double dt = 0.001;              ///< Time of that path, s, > 0.
};

/// Turns vectors along the surface with the surface's normal, on the shortest way. Their length
/// stays, so a stretched bristle that is carried over an edge keeps its energy and gains none.
class Turn {
 public:
  Turn() = default;
  /// Takes the unit normals before and now.
  Turn(const Eigen::Vector3d& n_before_W, const Eigen::Vector3d& n_W) noexcept
      : n_W_(n_W), sum_(n_before_W + n_W), scale_(1 + n_before_W.dot(n_W)) {}

  /// Carries a vector that was along the surface. If the normal turned by more than 150 degrees in
  /// one tick, it is another surface, and the result is zero. Real-time: safe.
  Eigen::Vector3d carry(const Eigen::Vector3d& v) const noexcept {
    constexpr double kScaleMin = 0.13;  // 1 + cos 150 degrees [chosen]
    // Written so that NaN gives zero.
    if (!(scale_ > kScaleMin)) return Eigen::Vector3d::Zero();
    return v - v.dot(n_W_) / scale_ * sum_;
  }

 private:
  Eigen::Vector3d n_W_{0, 0, 1};
  Eigen::Vector3d sum_{0, 0, 2};
  double scale_ = 2;
};

/// Follows the tip along the surface of one contact. Uses only positions: a velocity estimate would
/// bring its delay and its noise into the friction.
class TangentMotion {
 public:
  /// Takes the loop's period (s), which replaces an unknown `dt` of a tick.
  explicit TangentMotion(double period) noexcept : period_(period > 0 ? period : 0.001) {}

  /// Takes one tick of contact. Returns false and clears the state if position, normal or force is
  /// not finite: then there is no friction. In the first tick of a contact the path is zero.
  /// Real-time: safe.
  // Forced inline: otherwise a friction costs 40 instructions more in a program with other
  // frictions.
  [[gnu::always_inline]] bool follow(const driver::DeviceState& state,
                                     const SurfaceResponse& response, SlideTick& tick,
                                     Turn& turn) noexcept {
    const Eigen::Vector3d& n_W = response.contact.n_W;
    const double load = response.f_T_W.dot(n_W);
    // Written so that NaN is not usable.
    if (!(std::abs(n_W.squaredNorm() - 1) < 1e-6) || !(std::abs(load) < kLoadMax) ||
        !(state.p_WT.squaredNorm() < HUGE_VAL)) {
      leave();
      return false;
    }
    tick.n_W = n_W;
    tick.load = load > 0 ? load : 0;
    tick.depth = response.contact.depth > 0 ? response.contact.depth : 0;
    tick.dt = state.dt > 0 && state.dt < kPauseMax ? state.dt : period_;
    if (following_) {
      const Eigen::Vector3d way = state.p_WT - p_WT_before_;
      tick.slip = way - way.dot(n_W) * n_W;
      turn = Turn(n_before_W_, n_W);
    } else {
      tick.slip.setZero();
      turn = Turn(n_W, n_W);
    }
    p_WT_before_ = state.p_WT;
    n_before_W_ = n_W;
    following_ = true;
    return true;
  }

  /// Clears the state: the next tick begins a contact. Real-time: safe.
  void leave() noexcept { following_ = false; }

 private:
  static constexpr double kLoadMax = 1e9;   // N; a larger force is an error
  static constexpr double kPauseMax = 0.1;  // s; the arm's watchdog has fired by then

  double period_;
  bool following_ = false;
  Eigen::Vector3d p_WT_before_{0, 0, 0};
  Eigen::Vector3d n_before_W_{0, 0, 1};
};

}  // namespace thimble::render
