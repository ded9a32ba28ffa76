#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "carry/carried_trust.h"
#include "gravity_terms.h"
#include "thimble/driver/device_state.h"
#include "thimble/driver/force_law.h"
#include "thimble/scene/arm_file.h"

namespace thimble::session {

/// Gravity compensation: a force law that carries the arm's own weight beside what another law asks
/// for, so that a free tip stays where it is: a weight at the tip, and the links of a
/// serial arm by their pose, as far as the motion lets it be trusted. What it adds is part of the
/// requested force, so that the gate's soft start, limits and faults hold for the sum. Made only
/// for an arm whose file names a weight: a run without one calls its law itself.
class CarriedForce {
 public:
  /// Takes what an arm file says of it. Real-time: never from the servo thread.
  void take(const scene::ArmFile& file) noexcept {
    f_weight_W_ = {0, 0, file.carried_weight};
    if (!file.carried_moments.isZero(0)) links_ = scene::link_gravity(file);
  }
  /// Returns whether there is anything to carry. Real-time: safe.
  bool any() const noexcept { return f_weight_W_.z() > 0 || links_.most > 0; }
  /// Takes the law, which must outlive it. Real-time: safe.
  void put_before(driver::ForceLaw law) noexcept { law_ = law; }

  /// Returns the law's force and the one that carries. Real-time: safe if the law is.
  driver::ForceCommand operator()(const driver::DeviceState& state) noexcept {
    driver::ForceCommand command = law_(state);
    Eigen::Vector3d f_W = f_weight_W_;
    double energy = -f_weight_W_.dot(state.p_WT);  // J, of what is carried: its height
    if (links_.most > 0) {
      f_W += links_.carried(state.q);
      energy += links_.potential(state.q);
    }
    const double share = trust_.share(state, f_W, !command.f_T_W.isZero(0));
    command.f_T_W += share * f_W;
    command.stored += share * energy;
    return command;
  }

  /// Lets the law read what it will need.
  void prepare(const driver::DeviceState& expected) const noexcept { law_.prepare(expected); }

  /// Returns how often the force was taken away because the tip moved with it. Any thread.
  /// Real-time: safe.
  std::uint64_t withdrawn() const noexcept { return trust_.withdrawn(); }

 private:
  /// The law until there is one.
  struct NoForce {
    driver::ForceCommand operator()(const driver::DeviceState&) const noexcept { return {}; }
  };
  static inline NoForce no_force;

  driver::ForceLaw law_{no_force};
  Eigen::Vector3d f_weight_W_{0, 0, 0};  // N
  scene::LinkGravity links_;
  CarriedTrust trust_;
};

}  // namespace thimble::session
