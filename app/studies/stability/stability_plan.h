#pragma once

#include <cstddef>
#include <vector>

#include "stability/stability_laws.h"
#include "stability/wall_bench.h"

namespace thimble::studies {

/// What a study of stability is about.
struct StabilitySetup {
  scene::ArmFile arm;
  device_sim::HandSettings hand;
  stability::ArmDirection direction;  ///< That of all sweeps.
  stability::ArmDirection diagonal;   ///< In which the encoders' steps add up to the most.
  std::int64_t period_ns = 1'000'000;
  bool coarse = false;

  double period() const { return static_cast<double>(period_ns) * 1e-9; }
  std::int64_t delay_ns() const {
    return arm.simulated.wire.delay_in_ns + arm.simulated.wire.delay_out_ns;
  }
  double delay() const { return static_cast<double>(delay_ns()) * 1e-9; }
};

/// Which sweep a cell is of, and what its numbers are.
enum class StabilityPart {
  kLinearMap,  ///< a: stiffness, b: damping -> growth rate of the linear arm, 1/s.
  kArmMap,     ///< a: stiffness, b: damping -> last oscillation of the arm without energy stage, m.
  kLinearEdge,    ///< b: damping -> largest stiffness of the linear arm, N/m.
  kArmEdge,       ///< b: damping -> the same of the arm without energy stage.
  kGuardedEdge,   ///< b: damping -> the same of the arm as it is, with the gate's energy stage.
  kDiagonalEdge,  ///< b: damping -> that without energy stage along the diagonal.
  kRestitution,   ///< a: stiffness, b: damping, c: period s, d: delay s -> mean, least, most.
  kCycle,  ///< a: sigma, b: beta, c: start in counts, d: delay in periods -> oscillation in counts.
  kRateEdge,    ///< c: period s, d: delay s -> largest stiffness of an arm with b = 1.
  kDelayEdge,   ///< c: period s, d: delay s -> the same.
  kLateEdge,    ///< a: share of ticks that come three late -> the same.
  kSpreadEdge,  ///< a: spread of the period -> the same.
  kStepEdge,    ///< a: encoder step m -> largest stiffness that comes to rest, with the hand.
  kLagEdge,     ///< a: lag of the amplifiers s -> largest stiffness of an arm with b = 1.
  kCableEdge    ///< a: stiffness of the cable at the tip N/m, b: its damping -> the same.
};

/// One cell of the study's sweep.
struct StabilityCell {
  StabilityPart part;
  double a = 0, b = 0, c = 0, d = 0;
};

/// Lists all cells, in the order of the parts.
std::vector<StabilityCell> stability_cells(const StabilitySetup& setup);

/// Measures one cell: a pure function of its arguments. Fails as run_wall. Real-time: never from
/// the servo thread.
driver::Result<std::vector<double>> measure_stability(const StabilitySetup& setup,
                                                      const StabilityCell& cell);

// What pictures and figures must know of the plan.

inline constexpr double kBareDamping = 1;        // N s/m, of the arm in case 1 [PHYSICS 7]
inline constexpr double kCycleStiffness = 1000;  // N/m
/// The step of the encoders for the map of limit cycles, m: so coarse that a step's force is far
/// above a step of the motors' current.
inline constexpr double kCycleStep = 2e-4;
inline constexpr double kReleaseSpeed = 0.1;  // m/s, at which an oscillation begins
inline constexpr int kLatePeriods = 3;        // a late tick comes so many periods late

/// Returns the times of a loop in which a share of ticks comes late, and of one whose period
/// spreads evenly by +-spread.
scene::LoopTimes late_times(double period, double share);
scene::LoopTimes spread_times(double period, double spread);

/// Returns the speed (m/s) at which an oscillation of `counts` begins in the map of limit cycles.
double cycle_speed(const StabilitySetup& setup, double counts);

}  // namespace thimble::studies
