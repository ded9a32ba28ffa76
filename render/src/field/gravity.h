#pragma once

#include <Eigen/Core>
#include <string_view>

#include "thimble/driver/device_state.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// The weight of an object held in the hand: the same force everywhere. A Field; conservative.
class Gravity {
 public:
  static constexpr std::string_view kName = "gravity";

  struct Settings {
    double mass = 0;                               ///< kg
    Eigen::Vector3d acceleration{0, 0, -9.80665};  ///< W, m/s^2; standard gravity [CGPM 1901].

    /// Reads `mass` and `acceleration`. Real-time: never from the servo thread.
    void read(SettingsReader& reader, const EffectContext&) {
      reader.number("mass", mass, {.unit = "kg", .min = 0, .max = 10, .required = true});
      reader.vector("acceleration", acceleration, {.unit = "m/s^2", .min = -100, .max = 100});
    }
  };

  Gravity(const Settings& settings, const EffectContext&)
      : weight_W_(settings.mass * settings.acceleration) {}

  /// Returns the force on the hand, N in W. Real-time: safe.
  Eigen::Vector3d force(const driver::DeviceState&) const noexcept { return weight_W_; }
  /// Returns the energy at the tip, J: zero at the world's origin. Real-time: safe.
  double potential(const driver::DeviceState& state) const noexcept {
    return -weight_W_.dot(state.p_WT);
  }

 private:
  Eigen::Vector3d weight_W_;
};

}  // namespace thimble::render
