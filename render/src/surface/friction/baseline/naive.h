#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <string_view>

#include "surface/friction/friction_settings.h"
#include "surface/friction/friction_stage.h"

namespace thimble::render {

/// Textbook friction, against the direction of the last move. With quantized encoders it has a
/// limit cycle [BP 4.2]: kept to show why the others exist. [PHYSICS 2.1, A and B]
class NaiveFrictionLaw {
 public:
  static constexpr std::string_view kName = "naive";
  static constexpr bool kRests = false;  // it has a limit cycle

  /// Force in a tick without a move.
  enum class AtRest : std::size_t {
    kZero,  ///< No force: below one count per tick it is a damper and cannot hold.
    kHold,  ///< The last direction stays: after a stop it buzzes.
  };

  struct Settings {
    CoulombSettings coulomb;
    AtRest at_rest = AtRest::kZero;  ///< Force in a tick without a move.

    void read(SettingsReader& reader, const EffectContext& context);
  };

  explicit NaiveFrictionLaw(const Settings& settings) noexcept : settings_(settings) {}

  Eigen::Vector3d pull(const SlideTick& tick) noexcept;
  void turn(const Turn& turn) noexcept { direction_ = turn.carry(direction_); }
  void forget() noexcept { direction_.setZero(); }

  /// Returns the coefficients, which may be changed between two ticks. Real-time: safe.
  CoulombSettings& coulomb() noexcept { return settings_.coulomb; }

 private:
  Settings settings_;
  Eigen::Vector3d direction_{0, 0, 0};
};

using NaiveFriction = FrictionStage<NaiveFrictionLaw>;

}  // namespace thimble::render
