#pragma once

#include <utility>

#include "thimble/driver/device_state.h"
#include "thimble/driver/force_command.h"

namespace thimble::render {

/// Is the force law of a scene: just the stages the scene names, joined at compile time, so that a
/// stage that is not named costs nothing.
///
/// `Contact` finds what the tip touches: `const ContactState& update(const DeviceState&) noexcept`.
/// `SurfaceForce` says how that pushes back: `Vector3d force(const ContactState&, const
/// DeviceState&) noexcept`, N in the world. Real-time: safe if its stages are.
template <class Contact, class SurfaceForce>
class Touch {
 public:
  Touch(Contact contact, SurfaceForce surface_force)
      : contact_(std::move(contact)), surface_force_(std::move(surface_force)) {}

  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept {
    driver::ForceCommand command;
    const auto& contact = contact_.update(state);
    // Written so that a NaN depth means no contact and no force.
    if (contact.touching && contact.depth > 0) {
      command.f_T_W = surface_force_.force(contact, state);
      command.touch = {.in_contact = true,
                       .object = 0,
                       .feature = contact.triangle,
                       .depth = contact.depth,
                       .p_WP = contact.p_WP,
                       .n_W = contact.n_W,
                       .hops = contact.hops};
    }
    return command;
  }

  const Contact& contact() const noexcept { return contact_; }

 private:
  Contact contact_;
  SurfaceForce surface_force_;
};

}  // namespace thimble::render
