#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "thimble/driver/energy_guard.h"

namespace thimble::driver {

/// A book of what an arm did to the hand from tick to tick, for the energy stage of the gate:
/// effort times the motion of what it acts on, as many ticks late as the wire is.
///
/// Of an arm whose motors are known: torques as the message holds them, times the motion of the
/// joints; exact for motors that hold their torque, where f . dx would take the Jacobian of one end
/// of the way. Of an arm that takes forces: the force, times the way of the tip in the base; exact
/// for an arm that holds its force. All functions are Real-time: safe.
class WorkAccount {
 public:
  /// Takes the ticks from sampling to effort beyond the hold, 0 to EnergyGuardSettings::kDelayMost.
  explicit WorkAccount(int delay_ticks) noexcept : delay_(static_cast<std::size_t>(delay_ticks)) {
    restart();
  }

  /// Forgets the past.
  void restart() noexcept;

  /// Returns what came of the tick before. `x`: joint angles (rad), or the tip in the base (m);
  /// `p_WT`: the tip in the world, m; `f_sent_W`: the force that stood, N; `held`: what pressed
  /// springs hold, J.
  EnergyFlow flow(const Eigen::Vector3d& x, const Eigen::Vector3d& p_WT,
                  const Eigen::Vector3d& f_sent_W, double held) noexcept;

  /// Adds what the law said of its storages and of a program's force to the flow of this tick.
  /// `stored`: energy in the storages now, J; `f_program_W`: a program's part of the force that is
  /// asked for, N; `damping`: that arm and hand have for sure, N s/m; `dt`: of the tick, s.
  void explain(EnergyFlow& flow, double stored, const Eigen::Vector3d& f_program_W, double damping,
               double dt) noexcept;
  /// Takes a program's part of the force that was sent, N in the world, before `sent` or `hold`.
  void program_sent(const Eigen::Vector3d& f_W) noexcept {
    program_ = program_ || !f_W.isZero(0);
    f_program_W_ = f_W;
  }

  /// Lets a tick pass in which the arm took nothing: the effort of before stands.
  void hold() noexcept;
  /// Lets a tick pass in which the arm took an effort: torques (N m), or the force in its base (N).
  void sent(const Eigen::Vector3d& effort) noexcept;

 private:
  std::size_t delay_;
  std::array<Eigen::Vector3d, EnergyGuardSettings::kDelayMost + 1> efforts_;   // the newest first
  std::array<Eigen::Vector3d, EnergyGuardSettings::kDelayMost + 1> programs_;  // as efforts_, N
  Eigen::Vector3d f_program_W_{0, 0, 0};
  bool program_ = false;  // a program asked for a force at some time
  double stored_ = 0;     // J
  Eigen::Vector3d x_{0, 0, 0};
  Eigen::Vector3d p_WT_{0, 0, 0};
  bool begun_ = false;
};

}  // namespace thimble::driver
