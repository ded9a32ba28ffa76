#pragma once

#include <Eigen/Core>
#include <string_view>

#include "surface/friction/friction_settings.h"
#include "surface/friction/friction_stage.h"

namespace thimble::render {

/// Coulomb's set-valued friction on a massless point that is joined to the tip by a spring and a
/// damper. Solved by the implicit Euler step (the form of Kikuuwe and others) [PHYSICS 2.2, J].
/// Like the bristle with its own damping; static and sliding friction are the same.
class ImplicitCoulombLaw {
 public:
  static constexpr std::string_view kName = "implicit_coulomb";

  struct Settings {
    CoulombSettings coulomb;
    double stiffness = 1000;  ///< N/m
    double damping = 1;       ///< N s/m [PHYSICS 2.2]; each count adds damping * step / tick.

    void read(SettingsReader& reader, const EffectContext& context);
  };

  explicit ImplicitCoulombLaw(const Settings& settings) noexcept : settings_(settings) {}

  Eigen::Vector3d pull(const SlideTick& tick) noexcept;
  void turn(const Turn& turn) noexcept { bend_ = turn.carry(bend_); }
  void forget() noexcept { bend_.setZero(); }

  /// Returns the coefficients, which may be changed between two ticks. Real-time: safe.
  CoulombSettings& coulomb() noexcept { return settings_.coulomb; }

 private:
  Settings settings_;
  Eigen::Vector3d bend_{0, 0, 0};  // from the point to the tip, m
};

using ImplicitCoulombFriction = FrictionStage<ImplicitCoulombLaw>;

}  // namespace thimble::render
