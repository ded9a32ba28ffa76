#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "gravity/compensation_trust.h"
#include "gravity_terms.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/scene/arm_file.h"

namespace thimble::session {

/// Gravity compensation: the force that balances the weight of the arm, so that a free tip does not
/// move. It consists of a weight at the tip and of the links of a serial arm by their pose, reduced
/// as CompensationTrust requires. It is part of the requested force, so that the gate's soft start,
/// limits and faults apply to the sum. Last stage of RunLaw.
class GravityCompensation {
 public:
  /// Sets the parameters from an arm file. Real-time: never from the servo thread.
  void take(const scene::ArmFile& file) noexcept {
    f_weight_W_ = {0, 0, file.carried_weight};
    if (!file.carried_moments.isZero(0)) links_ = scene::link_gravity(file);
  }
  /// Returns whether there is a weight to compensate. Real-time: safe.
  bool any() const noexcept { return f_weight_W_.z() > 0 || links_.max_force > 0; }

  /// Adds the compensation force of a tick to the command of the law. Real-time: safe.
  void add_to(driver::ForceCommand& command, const driver::DeviceState& state) noexcept {
    Eigen::Vector3d f_W = f_weight_W_;
    double energy = -f_weight_W_.dot(state.p_WT);  // Potential energy of the compensated weight, J.
    if (links_.max_force > 0) {
      f_W += links_.carried(state.q);
      energy += links_.potential(state.q);
    }
    const double share = trust_.share(state, f_W, !command.f_T_W.isZero(0));
    command.f_T_W += share * f_W;
    command.stored += share * energy;
  }

  /// Returns how often the compensation was switched off because the tip moved along it. Any
  /// thread. Real-time: safe.
  std::uint64_t withdrawn() const noexcept { return trust_.withdrawn(); }

 private:
  Eigen::Vector3d f_weight_W_{0, 0, 0};  // N
  scene::LinkGravity links_;
  CompensationTrust trust_;
};

}  // namespace thimble::session
