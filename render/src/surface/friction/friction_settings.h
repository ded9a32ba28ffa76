#pragma once

#include <Eigen/Core>
#include <cmath>
#include <numbers>

#include "math/elementary.h"
#include "surface/friction/tangent_motion.h"
#include "thimble/driver/export.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

// Settings shared by several frictions.

/// Coefficients of dry friction: its share of the normal force.
struct CoulombSettings {
  double sliding = 0;  ///< While sliding, no unit, >= 0. The key `coefficient`, 0.3 if not given.
  double holding = 0;  ///< Before sliding; at least `sliding`. The key `static_coefficient`.

  /// Changes the sliding coefficient (> 0); the other keeps its ratio to it. Real-time: safe.
  void set_sliding(double coefficient) noexcept {
    holding = ratio() * coefficient;
    sliding = coefficient;
  }

  /// Returns the ratio of static to sliding friction, >= 1. Real-time: safe.
  double ratio() const noexcept { return sliding > 0 ? holding / sliding : 1; }

  /// Reads only the sliding coefficient. Real-time: never from the servo thread.
  void read_sliding(SettingsReader& reader);
  /// Reads both; if the second is not given, it is `ratio` times the first. Real-time: never from
  /// the servo thread.
  void read(SettingsReader& reader, double ratio = 1);
};

/// The part of a friction that grows with speed. It fades towards the surface, because it does not
/// end with the normal force by itself.
struct ViscousSettings {
  double viscous = 0;          ///< N s/m
  double fade_depth = 0.0005;  ///< Full from this depth on, m; 0: at once. [chosen]

  void read(SettingsReader& reader);

  /// Returns the coefficient at a depth (m), N s/m. Real-time: safe.
  double at(double depth) const noexcept {
    return depth < fade_depth ? viscous * (depth / fade_depth) : viscous;
  }
};

/// Returns the maximum stiffness (N/m) of a friction at which the arm stays quiet. The stuck
/// bristle is a wall, and
///     stiffness <= min( (b + b_hand) / (1.5 L), 2 c / step ),   L = tick / 2 + delay
/// [PHYSICS 2.3], with a hand of 3 N s/m [PHYSICS 0]. If the dry friction of the arm is not known,
/// only the first bound is used, and a limit cycle of a count at rest may remain. Real-time: never
/// from the servo thread.
THIMBLE_EXPORT double stick_stiffness_max(const EffectContext& context);

/// Reads the stiffness of a friction: `stiffness` (N/m), or `z_max` (m), the bend before sliding
/// where the arm pushes with its full force. The default is the maximum at which the arm stays
/// quiet; a stiffer one is refused. `holding` is the coefficient before sliding. Real-time: never
/// from the servo thread.
double read_stick_stiffness(SettingsReader& reader, const EffectContext& context, double holding);

/// One-pole low-pass filter of a vector. Real-time: safe.
class VectorLowPass {
 public:
  /// Takes the corner frequency, Hz.
  explicit VectorLowPass(double corner_frequency) noexcept : corner_frequency_(corner_frequency) {}

  /// Takes the next input, `dt` (s) after the last, and returns the filtered value. Real-time:
  /// safe.
  const Eigen::Vector3d& update(const Eigen::Vector3d& input, double dt) noexcept {
    if (dt != gain_dt_) {
      gain_dt_ = dt;
      gain_ = -math::expm1(-2 * std::numbers::pi * corner_frequency_ * dt);
    }
    value_ += gain_ * (input - value_);
    return value_;
  }
  void turn(const Turn& turn) noexcept { value_ = turn.carry(value_); }
  void forget() noexcept { value_.setZero(); }
  const Eigen::Vector3d& value() const noexcept { return value_; }  ///< Returns the last value.

 private:
  double corner_frequency_;
  double gain_dt_ = -1;
  double gain_ = 1;
  Eigen::Vector3d value_{0, 0, 0};
};

}  // namespace thimble::render
