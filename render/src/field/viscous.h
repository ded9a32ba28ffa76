#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string_view>

#include "thimble/driver/device_state.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/live_settings.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// A viscous liquid that fills the space: a force against the velocity. A Field; dissipates the
/// energy of every motion.
class Viscous {
 public:
  static constexpr std::string_view kName = "viscous";

  struct Settings {
    double damping = 0;  ///< N s/m

    /// Reads `damping`, and refuses values that the loop cannot hold. Against a free mass m, a
    /// damper delayed by L oscillates with growing amplitude beyond pi m / (2 L)
    /// [Nyquist's criterion for -b exp(-L s) / (m s)]. L is period + delay: the velocity is half a
    /// period old, and the force is held for another half. The filter of the velocity adds to this.
    /// Real-time: never from the servo thread.
    void read(SettingsReader& reader, const EffectContext& context);
  };

  Viscous(const Settings& settings, const EffectContext& context)
      : damping_(settings.damping), max_damping_(max_damping(context)) {}

  /// Returns the maximum damping that the loop can hold, N s/m: see Settings::read; infinite if the
  /// arm's mass is not known. Real-time: never from the servo thread.
  static double max_damping(const EffectContext& context);

  /// Lists the damping, up to two thirds of the maximum, because the filter of the velocity adds
  /// delay. Real-time: never from the servo thread.
  void list_settings(LiveSettings& settings) {
    constexpr double kMargin = 1.5, kUnknown = 20;  // chosen; N s/m
    const double most = max_damping_ < HUGE_VAL ? max_damping_ / kMargin : kUnknown;
    settings.add<[](Viscous& field, double b) noexcept { field.damping_ = b; }>(
        *this, {.name = "damping",
                .unit = "N s/m",
                .max = most,
                .value = damping_,
                .sensitivity = {.per_speed = 1}});
  }

  /// Returns the force on the hand, N in W; zero if the velocity is NaN or infinite. Real-time:
  /// safe.
  Eigen::Vector3d force(const driver::DeviceState& state) const noexcept {
    const Eigen::Vector3d push = -damping_ * state.v_WT;
    return push.allFinite() ? push : Eigen::Vector3d::Zero();
  }

 private:
  double damping_;
  double max_damping_;
};

}  // namespace thimble::render
