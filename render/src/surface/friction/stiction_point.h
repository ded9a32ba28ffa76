#pragma once

#include <Eigen/Core>
#include <string_view>

#include "surface/friction/friction_settings.h"
#include "surface/friction/friction_stage.h"

namespace thimble::render {

/// Holds the tip by a spring to a point of the surface. If pulled harder than static friction, the
/// point follows the tip until sliding friction is left, and holds again [BP 4.2]. While sliding it
/// grips and slips in turn, in steps of the difference of the two.
class StictionPointLaw {
 public:
  static constexpr std::string_view kName = "stiction_point";
  static constexpr double kRatio = 1.25;  ///< Static to sliding, if only one is given [chosen].

  struct Settings {
    CoulombSettings coulomb;
    double stiffness = 1000;  ///< Stiffness of the spring, N/m.

    void read(SettingsReader& reader, const EffectContext& context);
  };

  explicit StictionPointLaw(const Settings& settings) noexcept : settings_(settings) {}

  Eigen::Vector3d pull(const SlideTick& tick) noexcept;
  void turn(const Turn& turn) noexcept { pull_ = turn.carry(pull_); }
  void forget() noexcept { pull_.setZero(); }

  /// Returns the coefficients, which may be changed between two ticks. Real-time: safe.
  CoulombSettings& coulomb() noexcept { return settings_.coulomb; }

 private:
  Settings settings_;
  Eigen::Vector3d pull_{0, 0, 0};  // of the spring, N
};

using StictionPointFriction = FrictionStage<StictionPointLaw>;

}  // namespace thimble::render
