#pragma once

#include <Eigen/Core>

#include "link_gravity.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"

namespace thimble::session {

/// Gravity compensation by pose: a force law that carries the links of a serial arm beside what
/// another law asks for, as CarriedWeight carries a weight at the tip.
class CarriedLinks {
 public:
  /// Takes the law, which must outlive it, and the links.
  CarriedLinks(driver::ForceLaw law, const scene::LinkGravity& links) noexcept
      : law_(law), links_(links) {}

  /// Returns the law's force and the one that carries. Real-time: safe if the law is.
  driver::ForceCommand operator()(const driver::DeviceState& state) const noexcept {
    driver::ForceCommand command = law_(state);
    command.f_T_W += links_.carried(state.q);
    command.stored += links_.potential(state.q);
    return command;
  }

  /// Lets the law read what it will need.
  void prepare(const driver::DeviceState& expected) const noexcept { law_.prepare(expected); }

 private:
  driver::ForceLaw law_;
  scene::LinkGravity links_;
};

}  // namespace thimble::session
