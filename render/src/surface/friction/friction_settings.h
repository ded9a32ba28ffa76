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

// What several frictions are set by.

/// Dry friction's size: what share of the normal force holds back.
struct CoulombSettings {
  double sliding = 0;  ///< While sliding, no unit, >= 0. The key `coefficient`, 0.3 if not given.
  double holding = 0;  ///< Before it slides; at least `sliding`. The key `static_coefficient`.

  /// Changes the sliding coefficient (> 0); the other keeps its ratio to it. Real-time: safe.
  void set_sliding(double coefficient) noexcept {
    holding = ratio() * coefficient;
    sliding = coefficient;
  }

  /// Returns how much more it holds before it slides, >= 1. Real-time: safe.
  double ratio() const noexcept { return sliding > 0 ? holding / sliding : 1; }

  /// Reads the sliding coefficient alone. Real-time: never from the servo thread.
  void read_sliding(SettingsReader& reader);
  /// Reads both; where the second is not given it is `ratio` times the first.
  /// Real-time: never from the servo thread.
  void read(SettingsReader& reader, double ratio = 1);
};

/// The part of a friction that grows with speed. It fades towards the surface, because it does
/// not end with the normal force by itself.
struct ViscousSettings {
  double viscous = 0;          ///< N s/m
  double fade_depth = 0.0005;  ///< Full from this depth on, m; 0: at once. [chosen]

  void read(SettingsReader& reader);

  /// Returns the coefficient at a depth (m), N s/m. Real-time: safe.
  double at(double depth) const noexcept {
    return depth < fade_depth ? viscous * (depth / fade_depth) : viscous;
  }
};

/// Returns how stiff (N/m) a friction may hold, so that the arm stays quiet: the stuck bristle is a
/// wall, and
///     stiffness <= min( (b + b_hand) / (1.5 L), 2 c / step ),   L = tick / 2 + delay
/// [PHYSICS 2.3], with a hand of 3 N s/m [PHYSICS 0]. Without known dry friction of the
/// arm only the first bound is kept, and a flicker of a count at rest may remain.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT double stick_stiffness_max(const EffectContext& context);

/// Reads how stiff a friction holds: `stiffness` (N/m), or `z_max` (m), the way it gives before it
/// slides where the arm pushes with all its force. Without either it is as stiff as the arm can
/// hold still. What is stiffer is refused. `holding` is the coefficient before sliding. Real-time:
/// never from the servo thread.
double read_stick_stiffness(SettingsReader& reader, const EffectContext& context, double holding);

/// Smooths a vector by one pole. Real-time: safe.
class VectorLowPass {
 public:
  /// Takes the corner frequency, Hz.
  explicit VectorLowPass(double corner_frequency) noexcept : corner_frequency_(corner_frequency) {}

  /// Takes the next input, `dt` (s) after the last, and gives it filtered. Real-time: safe.
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
  const Eigen::Vector3d& value() const noexcept { return value_; }  ///< Returns the last, filtered.

 private:
  double corner_frequency_;
  double gain_dt_ = -1;
  double gain_ = 1;
  Eigen::Vector3d value_{0, 0, 0};
};

}  // namespace thimble::render
