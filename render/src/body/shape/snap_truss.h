#pragma once

#include <optional>

namespace thimble::render {

/// The law of a shallow pair of bars (von Mises truss): what a dimple in sheet metal does. Apart
/// by 2 a at their feet, a rise H at their joint, stiffness k each; u is the way that the joint is
/// pressed in, m. Stable at rest at u = 0 and u = 2 H; between them it snaps [PHYSICS 4].
class SnapTruss {
 public:
  /// Describes a truss by `half_span` a (m, > 0), `rise` H (m, > 0) and `bar_stiffness` k (N/m,
  /// > 0) of each bar. Anything else, NaN too, makes a truss that is flat and yields to nothing:
  /// `valid()` is false. Real-time: safe.
  SnapTruss(double half_span, double rise, double bar_stiffness) noexcept;

  // All of the following are Real-time: safe.

  bool valid() const noexcept { return k_ > 0; }  ///< Returns whether it can snap.
  double rise() const noexcept { return rise_; }  ///< Returns the height at rest, m.
  /// Returns the force (N) that holds the joint at `u`; and the energy in the bars (J).
  double force(double u) const noexcept;
  double energy(double u) const noexcept;  ///< Returns the energy in the bars, J.
  /// Returns the stiffness at `u`, N/m; below zero between the limit points.
  double stiffness(double u) const noexcept;

  /// Returns where the joint, pressed through a spring of `spring` N/m (0: by a dead load), leaves
  /// the first shape, m. Nothing if the spring is so stiff that the joint never jumps.
  std::optional<double> limit_point(double spring = 0) const noexcept;
  /// Returns the load under which it snaps in, N; out again at minus this.
  double limit_load() const noexcept;

  /// Finds the resting place of the joint under F(u) + spring u = load on the side of the first
  /// shape (`snapped` false) or the second; nothing if that shape cannot bear it. `load` (N) is the
  /// dead load plus spring times where the spring's other end is held. To 1e-15 of the size; 80
  /// rounds at most.
  std::optional<double> settle(double load, double spring, bool snapped) const noexcept;

 private:
  double shortening(double u, double length) const noexcept;

  double half_span_ = 1;
  double rise_ = 0;
  double k_ = 0;
  double bar_ = 1;  // the length of a bar at rest, m
};

}  // namespace thimble::render
