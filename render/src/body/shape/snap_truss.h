#pragma once

#include <optional>

namespace thimble::render {

/// The law of a shallow pair of bars (von Mises truss), a model of a dimple in sheet metal. The
/// feet are 2 a apart, the joint has the rise H, each bar the stiffness k; u is the displacement of
/// the joint inwards, m. Stable at rest at u = 0 and u = 2 H; between them it snaps [PHYSICS 4].
class SnapTruss {
 public:
  /// Makes a truss from `half_span` a (m, > 0), `rise` H (m, > 0) and `bar_stiffness` k (N/m, > 0)
  /// of each bar. Any other values, also NaN, make a flat truss that does not yield: `valid()` is
  /// false. Real-time: safe.
  SnapTruss(double half_span, double rise, double bar_stiffness) noexcept;

  // All of the following are Real-time: safe.

  bool valid() const noexcept { return k_ > 0; }  ///< Returns whether it can snap.
  double rise() const noexcept { return rise_; }  ///< Returns the height at rest, m.
  /// Returns the force (N) that holds the joint at `u`.
  double force(double u) const noexcept;
  double energy(double u) const noexcept;  ///< Returns the energy in the bars, J.
  /// Returns the stiffness at `u`, N/m; below zero between the limit points.
  double stiffness(double u) const noexcept;

  /// Returns the displacement at which the joint, pressed through a spring of `spring` N/m (0: by a
  /// dead load), leaves the first shape, m. Empty if the spring is so stiff that the joint never
  /// jumps.
  std::optional<double> limit_point(double spring = 0) const noexcept;
  /// Returns the load under which it snaps in, N; out again at minus this.
  double limit_load() const noexcept;

  /// Returns the resting place of the joint under F(u) + spring u = load on the side of the first
  /// shape (`snapped` false) or the second. Empty if that shape cannot bear the load. `load` (N) is
  /// the dead load plus spring times the position of the spring's other end. To 1e-15 of the size;
  /// at most 80 rounds.
  std::optional<double> settle(double load, double spring, bool snapped) const noexcept;

 private:
  double shortening(double u, double length) const noexcept;

  double half_span_ = 1;
  double rise_ = 0;
  double k_ = 0;
  double bar_ = 1;  // the length of a bar at rest, m
};

}  // namespace thimble::render
