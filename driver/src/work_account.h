#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>

#include "thimble/driver/energy_guard.h"

namespace thimble::driver {

/// The work of an arm on the hand, tick by tick, for the energy stage of the gate. It is effort
/// times the motion of the part that it drives, delayed by the ticks of the wire.
///
/// If the motors are known: torques as in the message, times the motion of the joints. This is
/// exact for motors that hold their torque, whereas f . dx would use the Jacobian of one end of the
/// way. If the arm takes forces: the force, times the way of the tip in the base. This is exact for
/// an arm that holds its force. All functions are Real-time: safe.
class WorkAccount {
 public:
  /// Takes the delay from sampling to effort in ticks, beyond the hold, 0 to
  /// EnergyGuardSettings::kDelayMax.
  explicit WorkAccount(int delay_ticks) noexcept : delay_(static_cast<std::size_t>(delay_ticks)) {
    restart();
  }

  /// Clears the history.
  void restart() noexcept;

  /// Returns the energy flow of the previous tick. `x`: joint angles (rad), or the tip in the base
  /// (m); `p_WT`: the tip in the world, m; `f_sent_W`: the force that acted, N; `held`: energy of
  /// pressed springs, J.
  EnergyFlow flow(const Eigen::Vector3d& x, const Eigen::Vector3d& p_WT,
                  const Eigen::Vector3d& f_sent_W, double held) noexcept;

  /// Adds the energy storages and the program's force that the law declared to the flow of this
  /// tick. `stored`: energy in the storages now, J; `f_program_W`: a program's part of the
  /// requested force, N; `damping`: guaranteed damping of arm and hand, N s/m; `dt`: of the tick,
  /// s.
  void explain(EnergyFlow& flow, double stored, const Eigen::Vector3d& f_program_W, double damping,
               double dt) noexcept;
  /// Takes a program's part of the force that was sent, N in the world, before `sent` or `hold`.
  void program_sent(const Eigen::Vector3d& f_W) noexcept {
    program_ = program_ || !f_W.isZero(0);
    f_program_W_ = f_W;
  }

  /// Records a tick in which the arm took nothing: the previous effort persists.
  void hold() noexcept;
  /// Records a tick in which the arm took an effort: torques (N m), or the force in its base (N).
  void sent(const Eigen::Vector3d& effort) noexcept;

 private:
  std::size_t delay_;
  std::array<Eigen::Vector3d, EnergyGuardSettings::kDelayMax + 1> efforts_;   // newest first
  std::array<Eigen::Vector3d, EnergyGuardSettings::kDelayMax + 1> programs_;  // as efforts_, N
  Eigen::Vector3d f_program_W_{0, 0, 0};
  bool program_ = false;  // a program has requested a force
  double stored_ = 0;     // J
  Eigen::Vector3d x_{0, 0, 0};
  Eigen::Vector3d p_WT_{0, 0, 0};
  bool begun_ = false;
};

}  // namespace thimble::driver
