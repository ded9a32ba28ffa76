#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>

#include "thimble/driver/force_law.h"
#include "thimble/driver/safety_gate.h"
#include "work_account.h"

namespace thimble::support {

/// A gate with its energy account, connected as in Device, around an arm that holds its force and
/// moves along a given path. The tick is 1 ms; the wire delays by some ticks.
class ExplainedRig {
 public:
  static constexpr double kTick = 1e-3;  // s

  ExplainedRig(const driver::GateLimits& limits, const driver::EnergyGuardSettings& energy)
      : settings_(energy), gate_(limits, energy), account_(energy.delay_ticks) {}

  /// Runs a tick with the tip at `p_W` (m) and the requested force `command`. Returns the sent
  /// force, N.
  Eigen::Vector3d tick(const Eigen::Vector3d& p_W, driver::ForceCommand command) {
    const Eigen::Vector3d move = begun_ ? Eigen::Vector3d(p_W - p_W_) : Eigen::Vector3d(0, 0, 0);
    const double dt = begun_ ? kTick : 0;
    work_ += felt_[static_cast<std::size_t>(settings_.delay_ticks)].dot(move);
    way_squared_ += move.squaredNorm();
    gate_.book_power(sent_W_.dot(move), dt);
    const double share = gate_.program_share(command.f_program_W, p_W, dt);
    command.f_T_W -= (1 - share) * command.f_program_W;
    command.f_program_W *= share;
    const double held = 0.5 * command.f_T_W.norm() * command.touch.depth;
    driver::EnergyFlow flow = account_.flow(p_W, p_W, sent_W_, held);
    account_.explain(flow, command.stored, command.f_program_W, settings_.dissipation, dt);
    const Eigen::Vector3d v_W = begun_ ? Eigen::Vector3d(move / kTick) : move;
    sent_W_ = gate_.pass_guarded(command.f_T_W, v_W, dt, flow).f_T_W();
    account_.program_sent(gate_.f_program_W());
    account_.sent(sent_W_);
    std::copy_backward(felt_.begin(), felt_.end() - 1, felt_.end());
    felt_[0] = sent_W_;
    max_work_ = std::max(max_work_, work_);
    p_W_ = p_W;
    begun_ = true;
    return sent_W_;
  }

  /// Runs at a fixed position until the soft start has ended.
  void open(const Eigen::Vector3d& p_W) {
    for (double t = 0; t <= gate_.limits().soft_start + 2 * kTick; t += kTick) tick(p_W, {});
  }

  const driver::SafetyGate& gate() const { return gate_; }
  double work() const { return work_; }          ///< Work of the delayed force on the hand, J.
  double max_work() const { return max_work_; }  ///< Largest value of `work` so far, J.
  double dissipated() const {                    ///< Energy dissipated by the assumed damping, J.
    return settings_.dissipation * way_squared_ / kTick;
  }
  /// Returns the force that acts on the tip now, N. It is delayed by the wire.
  const Eigen::Vector3d& felt_W() const {
    return felt_[static_cast<std::size_t>(settings_.delay_ticks)];
  }

 private:
  driver::EnergyGuardSettings settings_;
  driver::SafetyGate gate_;
  driver::WorkAccount account_;
  std::array<Eigen::Vector3d, driver::EnergyGuardSettings::kDelayMax + 2> felt_ = [] {
    std::array<Eigen::Vector3d, driver::EnergyGuardSettings::kDelayMax + 2> zeros;
    zeros.fill(Eigen::Vector3d::Zero());
    return zeros;
  }();
  Eigen::Vector3d p_W_{0, 0, 0}, sent_W_{0, 0, 0};
  double work_ = 0, max_work_ = 0, way_squared_ = 0;
  bool begun_ = false;
};

/// Returns the limits of the rig: 5 N, and the power of the shipped arms.
inline driver::GateLimits explained_limits() {
  return {.force_max = 5,
          .speed_max = 50,
          .rise_max = 1e5,
          .soft_start = 0.05,
          .stall_ns = 20'000'000,
          .watchdog_ns = 100'000'000,
          .power_max = 1,
          .power_time = 2};
}

/// Returns the energy stage of a shipped arm at 1 kHz with a wire of 1 ms.
inline driver::EnergyGuardSettings explained_stage() {
  return {.stage = driver::EnergyStage::kPassivity,
          .mass = 0.075,
          .allowance = 0.002,
          .reservoir = 0.015,
          .onset = 0.002,
          .speed_floor = 0.014,
          .dissipation = 1.005,
          .delay_ticks = 1};
}

}  // namespace thimble::support
