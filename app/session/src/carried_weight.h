#pragma once

#include <Eigen/Core>

#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"

namespace thimble::session {

/// Gravity compensation: a force law that carries the arm's own weight beside what another law asks
/// for, so that a tip that nobody holds stays where it is. What it adds is part of the requested
/// force, so that the gate's soft start, limits and faults hold for the sum. Made only for an arm
/// whose file names a weight: a run without one calls its law itself.
class CarriedWeight {
 public:
  /// Takes the law, which must outlive it, and what the motors carry, N in the world.
  CarriedWeight(driver::ForceLaw law, const Eigen::Vector3d& f_carried_W) noexcept
      : law_(law), f_carried_W_(f_carried_W) {}

  /// Returns the law's force and the one that carries. Real-time: safe if the law is.
  driver::ForceCommand operator()(const driver::DeviceState& state) const noexcept {
    driver::ForceCommand command = law_(state);
    command.f_T_W += f_carried_W_;
    command.stored -= f_carried_W_.dot(state.p_WT);
    return command;
  }

 private:
  driver::ForceLaw law_;
  Eigen::Vector3d f_carried_W_;  // N
};

}  // namespace thimble::session
