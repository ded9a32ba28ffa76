#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "carry/carried_trust.h"
#include "gravity_terms.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/scene/arm_file.h"

namespace thimble::session {

/// Gravity compensation: the force that carries the arm's own weight, so that a free tip stays
/// where it is: a weight at the tip, and the links of a serial arm by their pose, as far as the
/// motion lets it be trusted. It is part of the requested force, so that the gate's soft start,
/// limits and faults hold for the sum. The last stage of RunLaw.
class CarriedForce {
 public:
  /// Takes what an arm file says of it. Real-time: never from the servo thread.
  void take(const scene::ArmFile& file) noexcept {
    f_weight_W_ = {0, 0, file.carried_weight};
    if (!file.carried_moments.isZero(0)) links_ = scene::link_gravity(file);
  }
  /// Returns whether there is anything to carry. Real-time: safe.
  bool any() const noexcept { return f_weight_W_.z() > 0 || links_.most > 0; }

  /// Adds the force that carries the arm in a tick to what the law requests. Real-time: safe.
  void add_to(driver::ForceCommand& command, const driver::DeviceState& state) noexcept {
    Eigen::Vector3d f_W = f_weight_W_;
    double energy = -f_weight_W_.dot(state.p_WT);  // J, of what is carried: its height
    if (links_.most > 0) {
      f_W += links_.carried(state.q);
      energy += links_.potential(state.q);
    }
    const double share = trust_.share(state, f_W, !command.f_T_W.isZero(0));
    command.f_T_W += share * f_W;
    command.stored += share * energy;
  }

  /// Returns how often the force was taken away because the tip moved with it. Any thread.
  /// Real-time: safe.
  std::uint64_t withdrawn() const noexcept { return trust_.withdrawn(); }

 private:
  Eigen::Vector3d f_weight_W_{0, 0, 0};  // N
  scene::LinkGravity links_;
  CarriedTrust trust_;
};

}  // namespace thimble::session
