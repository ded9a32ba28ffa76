#pragma once

#include <Eigen/Core>
#include <string_view>

#include "surface/friction/friction_settings.h"
#include "surface/friction/friction_stage.h"

namespace thimble::render {

/// Karnopp's friction with a stick spring. Above a speed it slides, against the smoothed velocity.
/// Below half of it, or when the tip turns back, a spring and a damper hold [PHYSICS 2.2, G].
///
/// While sliding, the spring stays stretched and turns with the direction, so that changing between
/// the two creates no energy.
class KarnoppLaw {
 public:
  static constexpr std::string_view kName = "karnopp";

  struct Settings {
    CoulombSettings coulomb;
    double stiffness = 1000;  ///< Stiffness of the stick spring, N/m [PHYSICS 2.2].
    double damping = 1;       ///< Damping parallel to the spring, N s/m [PHYSICS 2.2].
    double speed = 0.02;      ///< Minimum sliding speed, m/s [chosen: 4 times one smoothed count].

    void read(SettingsReader& reader, const EffectContext& context);
  };

  explicit KarnoppLaw(const Settings& settings) noexcept
      : settings_(settings), velocity_(kSpeedCorner) {}

  Eigen::Vector3d pull(const SlideTick& tick) noexcept;
  void turn(const Turn& turn) noexcept;
  void forget() noexcept;

  /// Returns the coefficients, which may be changed between two ticks. Real-time: safe.
  CoulombSettings& coulomb() noexcept { return settings_.coulomb; }

 private:
  static constexpr double kSpeedCorner = 30;  // Hz [PHYSICS 2.2]

  Settings settings_;
  VectorLowPass velocity_;
  Eigen::Vector3d spring_{0, 0, 0};  // N
  bool slides_ = false;
};

using KarnoppFriction = FrictionStage<KarnoppLaw>;

}  // namespace thimble::render
