#pragma once

#include <Eigen/Core>

#include "thimble/driver/device_state.h"
#include "thimble/render/contact_state.h"
#include "thimble/render/effect/live_settings.h"
#include "thimble/render/surface/surface_response.h"

namespace thimble::render {

/// Spring and damper along the surface's normal: F = k x + b v, with the depth x and its rate v [BP
/// 2]. Never pulls, so that the surface does not stick. A SurfaceStage.
struct SpringDamper {
  double stiffness = 0;  ///< Stiffness k, N/m, >= 0. The scene's loader checks both.
  double damping = 0;    ///< Damping b, N s/m, >= 0.

  /// Returns the force on the hand, N in W. Precondition: the contact is touching. Zero if the
  /// depth is not above 0, as in the groove of a texture, or if depth, normal or velocity is NaN.
  /// Always inlined: a call would take 11 instructions more in each tick. Real-time: safe.
  [[gnu::always_inline]] Eigen::Vector3d force(const ContactState& contact,
                                               const driver::DeviceState& state) const noexcept {
    const double growth = -contact.n_W.dot(state.v_WT);
    const double magnitude = stiffness * contact.depth + damping * growth;
    // Written so that NaN means no force.
    if (!(magnitude > 0 && contact.depth > 0)) return Eigen::Vector3d::Zero();
    return magnitude * contact.n_W;
  }

  /// Adds the force to the response. Real-time: safe.
  [[gnu::always_inline]] void touch(const driver::DeviceState& state,
                                    SurfaceResponse& response) const noexcept {
    response.f_T_W += force(response.contact, state);
  }
  void leave() const noexcept {}
  double spring_stiffness() const noexcept { return stiffness; }  ///< Returns `stiffness`.

  /// Adds stiffness and damping. Real-time: never from the servo thread.
  void list_settings(LiveSettings& settings) {
    settings.add<[](SpringDamper& spring, double k) noexcept { spring.stiffness = k; }>(
        *this, {.name = "stiffness",
                .unit = "N/m",
                .max = settings.stiffness_max(),
                .value = stiffness,
                .sensitivity = {.per_depth = 1}});
    settings.add<[](SpringDamper& spring, double b) noexcept { spring.damping = b; }>(
        *this, {.name = "damping",
                .unit = "N s/m",
                .max = settings.damping_max(),
                .value = damping,
                .sensitivity = {.per_speed = 1}});
  }
};

}  // namespace thimble::render
