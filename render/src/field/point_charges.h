#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string_view>
#include <vector>

#include "thimble/driver/device_state.h"
#include "thimble/render/effect/effect_context.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// The field of electric charges on a charged tip [BP 2]. A Field; conservative.
///
/// The force of a point charge is unbounded. Here each charge is softened as if spread over a ball
/// (Plummer's law). With s the vector from charge to tip, F = q s / (|s|^2 + a^2)^(3/2), minus the
/// gradient of q / sqrt(|s|^2 + a^2). So the force is largest at |s| = a / sqrt 2, where it is 2 q
/// / (3 sqrt 3 a^2). A scene gives this maximum force and a. At the centre of an attracting charge
/// the tip is held like by a spring of 2.6 force / a.
class PointCharges {
 public:
  static constexpr std::string_view kName = "charges";

  struct Settings {
    /// One charge.
    struct One {
      Eigen::Vector3d p_O{0, 0, 0};  ///< In the object's frame, m.
      double force = 0;              ///< Maximum force, N; negative attracts.
      double radius = 0.01;          ///< a, m
    };
    std::vector<One> charges;  ///< All charges.

    /// Reads the list `charges`: position, force, radius. Real-time: never from the servo thread.
    void read(SettingsReader& reader, const EffectContext& context);
  };

  /// Real-time: never from the servo thread.
  PointCharges(const Settings& settings, const EffectContext& context);

  /// Returns the force on the hand, N in W; zero if the tip is NaN or infinite. Real-time: safe; a
  /// few ns per charge.
  Eigen::Vector3d force(const driver::DeviceState& state) const noexcept {
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Charge& charge : charges_) {
      const Eigen::Vector3d s_W = state.p_WT - charge.p_W;
      const double square = s_W.squaredNorm() + charge.radius * charge.radius;
      sum += charge.strength / (square * std::sqrt(square)) * s_W;
    }
    return sum.allFinite() ? sum : Eigen::Vector3d::Zero();
  }
  /// Returns the energy at the tip, J: zero far away, and if the tip is NaN or infinite. Real-time:
  /// safe.
  double potential(const driver::DeviceState& state) const noexcept {
    double sum = 0;
    for (const Charge& charge : charges_) {
      const Eigen::Vector3d s_W = state.p_WT - charge.p_W;
      sum += charge.strength / std::sqrt(s_W.squaredNorm() + charge.radius * charge.radius);
    }
    return std::isfinite(sum) ? sum : 0;
  }

 private:
  struct Charge {
    Eigen::Vector3d p_W;
    double strength;  // q, N m^2
    double radius;    // a, m
  };
  std::vector<Charge> charges_;
};

}  // namespace thimble::render
