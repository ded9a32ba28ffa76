#pragma once

#include <Eigen/Core>
#include <string_view>

#include "surface/friction/friction_settings.h"
#include "surface/friction/friction_stage.h"

namespace thimble::render {

/// Dahl's friction: it grows with the path, dF/dx = stiffness (1 - F / F_c), and approaches sliding
/// friction without a corner. Integrated over each tick by its exact solution, exp in |dx|, so that
/// no step is too long [PHYSICS 2.2, I]. Soft and rounded; static and sliding friction are the
/// same.
class DahlLaw {
 public:
  static constexpr std::string_view kName = "dahl";

  struct Settings {
    CoulombSettings coulomb;
    double stiffness = 1000;  ///< At the first move, N/m.

    void read(SettingsReader& reader, const EffectContext& context);
  };

  explicit DahlLaw(const Settings& settings) noexcept : settings_(settings) {}

  Eigen::Vector3d pull(const SlideTick& tick) noexcept;
  void turn(const Turn& turn) noexcept { pull_ = turn.carry(pull_); }
  void forget() noexcept { pull_.setZero(); }

  /// Returns the coefficients, which may be changed between two ticks. Real-time: safe.
  CoulombSettings& coulomb() noexcept { return settings_.coulomb; }

 private:
  Settings settings_;
  Eigen::Vector3d pull_{0, 0, 0};  // N
};

using DahlFriction = FrictionStage<DahlLaw>;

}  // namespace thimble::render
