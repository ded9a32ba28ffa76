#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string_view>

#include "surface/friction/friction_settings.h"
#include "surface/friction/friction_stage.h"

namespace thimble::render {

/// The paper's solution: friction that depends on velocity, with smoothed direction, dry friction
/// (depth times stiffness times coefficient) and viscous friction in any proportion [BP 4.2]. It is
/// quiet, but cannot hold at rest: it creeps under any load. [PHYSICS 2.2, D, E and F]
class PaperFrictionLaw {
 public:
  static constexpr std::string_view kName = "paper";
  static constexpr bool kRests = false;  // it creeps under any load

  /// Smoothed quantity.
  enum class Smooth : std::size_t {
    kVelocity,   ///< The velocity; force proportional to it up to `speed` (D).
    kDirection,  ///< Only the direction of the last move: the force is calmer, the hand is not (E).
    kTwice,      ///< Velocity and then direction, rounded by tanh: quietest, slowest (F).
  };

  struct Settings {
    CoulombSettings coulomb;
    ViscousSettings viscous;
    Smooth smooth = Smooth::kVelocity;  ///< Smoothed quantity.
    double corner_frequency = 30;       ///< Hz [PHYSICS 2.2]; 10 for kTwice.
    double speed = 0.01;                ///< Speed of full dry friction, m/s [PHYSICS 2.2].

    void read(SettingsReader& reader, const EffectContext& context);
  };

  explicit PaperFrictionLaw(const Settings& settings) noexcept
      : settings_(settings),
        velocity_(settings.corner_frequency),
        direction_(settings.corner_frequency) {}

  Eigen::Vector3d pull(const SlideTick& tick) noexcept;
  void turn(const Turn& turn) noexcept;
  void forget() noexcept;

  /// Returns the coefficients, which may be changed between two ticks. Real-time: safe.
  CoulombSettings& coulomb() noexcept { return settings_.coulomb; }

 private:
  Eigen::Vector3d dry(const SlideTick& tick) noexcept;

  Settings settings_;
  VectorLowPass velocity_, direction_;
  Eigen::Vector3d last_move_{0, 0, 0};
};

using PaperFriction = FrictionStage<PaperFrictionLaw>;

}  // namespace thimble::render
