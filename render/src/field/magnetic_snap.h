#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string_view>
#include <vector>

#include "thimble/driver/device_state.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// Attracts the tip to points and lines once it is near. A Field; conservative.
///
/// At distance r from a target, within its capture radius R, the energy is -U (1 - (r/R)^2)^2. The
/// pull begins at R without a step, is largest at R / sqrt 3 and zero on the target. There it holds
/// the tip like a spring of 2.6 force / R. Targets that overlap add up. On a line, all its points
/// are equal: the tip slides along it freely.
class MagneticSnap {
 public:
  static constexpr std::string_view kName = "magnetic_snap";

  struct Settings {
    /// A point or line that attracts the tip.
    struct Target {
      Eigen::Vector3d from_O{0, 0, 0};  ///< The point, or one end of the line; object's frame, m.
      Eigen::Vector3d to_O{0, 0, 0};    ///< The other end; equal to `from_O` for a point.
      double force = 0;                 ///< Maximum force, N.
      double radius = 0;                ///< R, m
    };
    std::vector<Target> targets;  ///< All targets.

    /// Reads the list `targets`: point, or from and to; force, capture_radius.
    /// Real-time: never from the servo thread.
    void read(SettingsReader& reader, const EffectContext& context);
  };

  /// Real-time: never from the servo thread.
  MagneticSnap(const Settings& settings, const EffectContext& context);

  /// Returns the force on the hand, N in W; zero if the tip is NaN or infinite. Real-time: safe; a
  /// few ns per target.
  Eigen::Vector3d force(const driver::DeviceState& state) const noexcept;
  /// Returns the energy at the tip, J: zero beyond all radii, negative within the radius of a
  /// target. Real-time: safe.
  double potential(const driver::DeviceState& state) const noexcept;

 private:
  struct Target {
    Eigen::Vector3d from_W;
    Eigen::Vector3d way_W;  // from `from_W` to the other end, m; zero for a point
    double per_square;      // 1 / |way|^2, 0 for a point
    double stiffness;       // at the target, N/m
    double square;          // R^2, m^2
  };
  /// Computes the vector from the nearest point of a target to the tip, m; returns 1 less its
  /// square over that of the radius.
  static double left_of(const Target& target, const Eigen::Vector3d& p_WT,
                        Eigen::Vector3d& away_W) noexcept;

  std::vector<Target> targets_;
};

}  // namespace thimble::render
