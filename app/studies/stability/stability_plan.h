#pragma once

#include <cstddef>
#include <vector>

#include "stability/stability_laws.h"
#include "stability/wall_bench.h"

namespace thimble::studies {

/// Settings of a study of stability.
struct StabilitySetup {
  scene::ArmFile arm;
  device_sim::HandSettings hand;
  stability::ArmDirection direction;  ///< Direction of all sweeps.
  stability::ArmDirection diagonal;   ///< Direction with the largest sum of encoder steps.
  std::int64_t period_ns = 1'000'000;
  bool coarse = false;

  double period() const { return static_cast<double>(period_ns) * 1e-9; }
  std::int64_t delay_ns() const {
    return arm.simulated.wire.delay_in_ns + arm.simulated.wire.delay_out_ns;
  }
  double delay() const { return static_cast<double>(delay_ns()) * 1e-9; }
};

/// The sweep of a cell, and the meaning of its numbers.
enum class StabilityPart {
  kLinearMap,     ///< a: stiffness, b: damping -> growth rate of the linear arm, 1/s.
  kArmMap,        ///< a: stiffness, b: damping -> final oscillation without energy stage, m.
  kLinearEdge,    ///< b: damping -> largest stiffness of the linear arm, N/m.
  kArmEdge,       ///< b: damping -> largest stiffness of the arm without energy stage, N/m.
  kGuardedEdge,   ///< b: damping -> largest stiffness of the arm with the gate's energy stage, N/m.
  kDiagonalEdge,  ///< b: damping -> as kArmEdge, along the diagonal.
  kRestitution,   ///< a: stiffness, b: damping, c: period s, d: delay s -> mean, minimum, maximum.
  kCycle,  ///< a: sigma, b: beta, c: start in counts, d: delay in periods -> oscillation in counts.
  kRateEdge,    ///< c: period s, d: delay s -> largest stiffness of an arm with b = 1.
  kDelayEdge,   ///< c: period s, d: delay s -> as kRateEdge.
  kLateEdge,    ///< a: fraction of ticks that are three periods late -> as kRateEdge.
  kSpreadEdge,  ///< a: spread of the period -> as kRateEdge.
  kStepEdge,    ///< a: encoder step m -> largest stiffness that comes to rest, with the hand.
  kLagEdge,     ///< a: lag of the amplifiers s -> largest stiffness of an arm with b = 1.
  kCableEdge    ///< a: stiffness of the cable at the tip N/m, b: its damping -> as kLagEdge.
};

/// One cell of the study's sweep.
struct StabilityCell {
  StabilityPart part;
  double a = 0, b = 0, c = 0, d = 0;
};

/// Lists all cells, in the order of the parts.
std::vector<StabilityCell> stability_cells(const StabilitySetup& setup);

/// Measures one cell: a pure function of its arguments. Fails like run_wall. Real-time: never from
/// the servo thread.
driver::Result<std::vector<double>> measure_stability(const StabilitySetup& setup,
                                                      const StabilityCell& cell);

// Constants of the plan for pictures and figures.

inline constexpr double kBareDamping = 1;        // N s/m, of the arm in case 1 [PHYSICS 7]
inline constexpr double kCycleStiffness = 1000;  // N/m
/// Encoder step for the map of limit cycles, m: so coarse that the force of a step is far above a
/// step of the motors' current.
inline constexpr double kCycleStep = 2e-4;
inline constexpr double kReleaseSpeed = 0.1;  // m/s, initial speed of an oscillation
inline constexpr int kLatePeriods = 3;        // delay of a late tick in periods

/// Returns the times of a loop with a fraction of late ticks, and of one whose period is uniformly
/// distributed within +-spread.
scene::LoopTimes late_times(double period, double share);
scene::LoopTimes spread_times(double period, double spread);

/// Returns the initial speed (m/s) of an oscillation of `counts` in the map of limit cycles.
double cycle_speed(const StabilitySetup& setup, double counts);

}  // namespace thimble::studies
