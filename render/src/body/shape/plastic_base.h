#pragma once

#include <Eigen/Core>
#include <limits>

namespace thimble::render {

/// Sets how a base point yields: clay.
struct PlasticSettings {
  double stiffness = 1000;  ///< N/m, > 0: of the spring between vertex and base point
  double yield_force = 1;   ///< N, >= 0: more than this moves the base point
  /// m/s, > 0: how fast the base point flows at most [BP 4.3: the time variable made small].
  double flow_rate = std::numeric_limits<double>::infinity();
  /// m, >= 0: how far the base point may go from its first place in all [BP 4.3: limiting to some
  /// degree their movement]; movement_limits() finds what no triangle minds.
  double movement_limit = std::numeric_limits<double>::infinity();

  /// Tells whether the settings make sense; if not, the base point does not move.
  bool valid() const noexcept {
    return stiffness > 0 && yield_force >= 0 && flow_rate > 0 && movement_limit >= 0 &&
           stiffness < kStiffnessMax;
  }
  static constexpr double kStiffnessMax = 1e15;  ///< N/m; beyond, squares would overflow
};

/// Is a base point that keeps part of what it gave way: a spring in a row with a slider [STABILITY
/// 4, plastic truth]. Pressed to x_max it keeps x_max - F_y / k, turns F_y times that into heat,
/// and is as stiff from there on as it was before.
///
/// Never gives energy: the slider moves along the force that pulls it, into a ball, so that the
/// force does work on it in each step.
class PlasticBase {
 public:
  explicit PlasticBase(const PlasticSettings& settings) noexcept : settings_(settings) {}

  // All of the following are Real-time: safe.

  /// Holds the vertex at `x` (m from the base point's first place) for `step` s and lets the base
  /// point yield. NaN, or settings that make no sense: it stays.
  void pull(const Eigen::Vector3d& x, double step) noexcept;

  /// Tells the force on a vertex at `x`, N: towards the base point.
  Eigen::Vector3d force(const Eigen::Vector3d& x) const noexcept {
    return settings_.stiffness * (p_ - x);
  }
  /// Tells where the base point is now, m from its first place: the set.
  const Eigen::Vector3d& displacement() const noexcept { return p_; }
  /// Sums up what was turned into heat, J; never falls.
  double dissipated() const noexcept { return dissipated_; }
  /// Tells the energy in the spring while the vertex is at `x`, J.
  double energy(const Eigen::Vector3d& x) const noexcept {
    return settings_.stiffness * (x - p_).squaredNorm() / 2;
  }

 private:
  PlasticSettings settings_;
  Eigen::Vector3d p_{0, 0, 0};
  double dissipated_ = 0;
};

}  // namespace thimble::render
