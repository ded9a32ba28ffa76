#pragma once

#include <Eigen/Core>
#include <string_view>

#include "surface/friction/friction_settings.h"
#include "surface/friction/friction_stage.h"
#include "thimble/driver/export.h"

namespace thimble::render {

/// The recommended friction: a bristle between tip and surface that bends with the path. It is
/// dragged along when it would pull harder than friction can (the form of Hayward and Armstrong)
/// [PHYSICS 2.2, H].
///
/// It uses only positions, so it neither drifts nor relaxes, and an encoder count changes its force
/// by stiffness times step. Once it slides, it holds with the sliding coefficient until it has bent
/// back by half; then static friction holds again. The bristle's spring is the same at every load:
/// one that stiffened with the load would create energy when pressed.
class THIMBLE_EXPORT BristleLaw {
 public:
  static constexpr std::string_view kName = "bristle";

  struct Settings {
    CoulombSettings coulomb;
    double stiffness = 1000;  ///< N/m; F / z_max of [PHYSICS 2.3].

    void read(SettingsReader& reader, const EffectContext& context);
  };

  explicit BristleLaw(const Settings& settings) noexcept : settings_(settings) {}

  Eigen::Vector3d pull(const SlideTick& tick) noexcept;
  void turn(const Turn& turn) noexcept { pull_ = turn.carry(pull_); }
  void forget() noexcept {
    pull_.setZero();
    slides_ = false;
  }

  /// Returns the coefficients, which may be changed between two ticks. Real-time: safe.
  CoulombSettings& coulomb() noexcept { return settings_.coulomb; }

 private:
  Settings settings_;
  Eigen::Vector3d pull_{0, 0, 0};  // of the bent bristle, N
  bool slides_ = false;
};

using BristleFriction = FrictionStage<BristleLaw>;

}  // namespace thimble::render
