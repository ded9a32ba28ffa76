#pragma once

#include <Eigen/Core>
#include <string_view>

#include "surface/friction/friction_settings.h"
#include "surface/friction/friction_stage.h"

namespace thimble::render {

/// The LuGre friction: Dahl's bristles with damping (sigma1), viscous friction (sigma2) and
/// friction that falls with speed (Stribeck), from static to sliding over `stribeck_speed`.
///
/// The bristles follow z <- z_ss + (z - z_ss) exp(-sigma0 |v| T / g), which is stable at any
/// stiffness and speed. Euler's step would diverge where T sigma0 |v| / g > 2 [PHYSICS 2.4]. Dry
/// part and damping together stay below static friction. It is known to drift under an oscillating
/// load (4.9 um per cycle there); use the bristle for holding still.
class LugreLaw {
 public:
  static constexpr std::string_view kName = "lugre";

  struct Settings {
    CoulombSettings coulomb;
    ViscousSettings viscous;       ///< sigma2
    double stiffness = 1000;       ///< sigma0, N/m.
    double damping = 0;            ///< sigma1, N s/m.
    double stribeck_speed = 0.01;  ///< m/s [chosen: the knee of PHYSICS 2.2]

    /// Refuses settings that are not passive: sigma2 >= sigma1 (F_s - F_c) / F_c [PHYSICS 2.4].
    void read(SettingsReader& reader, const EffectContext& context);
  };

  explicit LugreLaw(const Settings& settings) noexcept
      : settings_(settings), velocity_(kSpeedCorner) {}

  Eigen::Vector3d pull(const SlideTick& tick) noexcept;
  void turn(const Turn& turn) noexcept;
  void forget() noexcept;

  /// Returns the coefficients, which may be changed between two ticks. Real-time: safe.
  CoulombSettings& coulomb() noexcept { return settings_.coulomb; }

 private:
  // Hz; without it one count per tick would sweep the whole Stribeck curve [PHYSICS 2.2].
  static constexpr double kSpeedCorner = 30;

  Settings settings_;
  VectorLowPass velocity_;
  Eigen::Vector3d spring_{0, 0, 0};  // sigma0 z, N
};

using LugreFriction = FrictionStage<LugreLaw>;

}  // namespace thimble::render
