#include "studies/stability/stability_plan.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "energy_guard_settings.h"
#include "stability/stability_laws.h"
#include "studies/stability/drive_train_walls.h"
#include "studies/stability/wall_measures.h"

namespace thimble::studies {
namespace {

// The limits of all maps: five decades of each, from the passivity bound to beyond any arm.
constexpr double kStiffnessMin = 1, kStiffnessMax = 1e5;  // N/m
constexpr double kDampingMin = 1e-3, kDampingMax = 1e2;   // N s/m
constexpr double kQuiet = 0.25;   // counts: a smaller oscillation counts as rest
constexpr double kEdgeRange = 4;  // an edge is searched within this factor of the law

/// Returns `count` values from `least` to `most`, evenly spaced on a logarithmic scale.
std::vector<double> octaves(double min, double max, int count) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    values.push_back(min * std::pow(max / min, static_cast<double>(i) / (count - 1)));
  }
  return values;
}

std::vector<double> even(double min, double max, int count) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) values.push_back(min + (max - min) * i / (count - 1));
  return values;
}

/// Returns a case with a linear arm: no dry friction, ideal encoders, no limits.
stability::WallCase linear_case(const StabilitySetup& setup) {
  stability::WallCase wall;
  wall.direction = setup.direction;
  wall.tip = setup.arm.simulated.plant;
  wall.tip.coulomb = 0;
  wall.hand = setup.hand;
  wall.velocity_corner = setup.arm.velocity_corner_frequency;
  wall.period_ns = setup.period_ns;
  wall.delay_ns = setup.delay_ns();
  wall.duration = 2;
  return wall;
}

/// Returns a case with the arm's friction, encoders and limits, but without the energy stage of its
/// gate, which the laws do not cover.
stability::WallCase arm_case(const StabilitySetup& setup,
                             const stability::ArmDirection& direction) {
  stability::WallCase wall = linear_case(setup);
  wall.direction = direction;
  wall.tip = setup.arm.simulated.plant;
  wall.own_step = true;
  wall.own_limits = true;
  return wall;
}

/// Returns a case with a free linear arm with b = 1, as in case 1 of [PHYSICS 7].
stability::WallCase bare_case(const StabilitySetup& setup) {
  stability::WallCase wall = linear_case(setup);
  wall.hand = {};
  wall.tip.viscous = kBareDamping;
  wall.velocity_corner = 0;
  wall.delay_ns = 0;
  wall.duration = 4;
  return wall;
}

std::int64_t to_ns(double seconds) {
  return std::llround(seconds * 1e9);
}

driver::Result<double> edge_by_law(const StabilitySetup& setup, const stability::WallCase& wall,
                                   const scene::LoopTimes& times) {
  const double law = scene::stiffness_limit(kBareDamping, scene::latency_of(times));
  return linear_edge(setup.arm, wall, law / kEdgeRange, law * kEdgeRange);
}

driver::Result<double> arm_oscillation(const StabilitySetup& setup,
                                       const stability::WallCase& wall) {
  return setup.hand.stiffness > 0 ? pressed_oscillation(setup.arm, wall)
                                  : released_oscillation(setup.arm, wall, kReleaseSpeed, 2);
}

driver::Result<double> arm_edge(const StabilitySetup& setup,
                                const stability::ArmDirection& direction, double damping,
                                bool guarded) {
  stability::WallCase wall = arm_case(setup, direction);
  if (guarded) {
    wall.energy =
        scene::energy_settings(setup.arm, 1e9 / static_cast<double>(wall.period_ns), std::nullopt);
  }
  wall.damping = damping;
  const double quiet = kQuiet * direction.step;
  return setup.hand.stiffness > 0
             ? pressed_edge(setup.arm, wall, quiet, kStiffnessMin, kStiffnessMax)
             : released_edge(setup.arm, wall, kReleaseSpeed, 2, quiet, kStiffnessMin,
                             kStiffnessMax);
}

driver::Result<double> cycle(const StabilitySetup& setup, const StabilityCell& cell) {
  stability::WallCase wall = bare_case(setup);
  const double period = setup.period();
  wall.stiffness = kCycleStiffness;
  wall.step = kCycleStep;
  wall.tip.coulomb = cell.a * kCycleStiffness * kCycleStep;
  wall.tip.viscous = cell.b * kCycleStiffness * period;
  wall.delay_ns = to_ns(cell.d * period);
  // The growth rate is (K T / m) times the distance from the corner; the duration is long enough to
  // distinguish growth from decay.
  const double growth_time = wall.tip.mass / (kCycleStiffness * period);
  const double duration = (setup.coarse ? 40 : 70) * growth_time;
  const auto oscillation =
      released_oscillation(setup.arm, wall, cycle_speed(setup, cell.c), duration);
  if (!oscillation) return oscillation.error();
  return *oscillation / kCycleStep;
}

/// Returns the largest stiffness that comes to rest with encoders of one step.
driver::Result<double> step_edge(const StabilitySetup& setup, double step) {
  stability::WallCase wall = linear_case(setup);
  wall.tip = setup.arm.simulated.plant;
  wall.velocity_corner = 0;
  wall.step = step;
  return released_edge(setup.arm, wall, kReleaseSpeed, 2, 1e-3 * step, 10, kStiffnessMax);
}

/// Returns the number of a cell as a list.
driver::Result<std::vector<double>> alone(const driver::Result<double>& number) {
  if (!number) return number.error();
  return std::vector<double>{*number};
}

void add_maps(const StabilitySetup& setup, std::vector<StabilityCell>& cells) {
  const int count = setup.coarse ? 11 : 51;
  const auto stiffnesses = octaves(kStiffnessMin, kStiffnessMax, count);
  const auto dampings = octaves(kDampingMin, kDampingMax, count);
  for (const auto part : {StabilityPart::kLinearMap, StabilityPart::kArmMap}) {
    for (const double damping : dampings) {
      for (const double stiffness : stiffnesses) cells.push_back({part, stiffness, damping});
    }
  }
  for (const auto part : {StabilityPart::kLinearEdge, StabilityPart::kArmEdge,
                          StabilityPart::kGuardedEdge, StabilityPart::kDiagonalEdge}) {
    for (const double damping : octaves(kDampingMin, kDampingMax, setup.coarse ? 11 : 101)) {
      cells.push_back({part, 0, damping});
    }
  }
}

void add_restitution(const StabilitySetup& setup, std::vector<StabilityCell>& cells) {
  struct Series {
    double period, delay, damping;
  };
  const double mass = setup.arm.simulated.plant.mass;
  for (const Series& s : {Series{0.001, 0, 0}, Series{0.001, 0.001, 0}, Series{0.001, 0.002, 0},
                          Series{0.00025, 0, 0}, Series{0.000125, 0, 0}, Series{0.001, 0, 2}}) {
    // Beyond this, the law's condition K L^2 / m << 1 is violated [PHYSICS 1.1].
    const double latency = s.period / 2 + s.delay;
    const double max = std::min(0.3 * mass / (latency * latency), 3e4);
    for (const double stiffness : octaves(100, max, setup.coarse ? 4 : 20)) {
      cells.push_back({StabilityPart::kRestitution, stiffness, s.damping, s.period, s.delay});
    }
  }
}

void add_cycles(const StabilitySetup& setup, std::vector<StabilityCell>& cells) {
  // No point of the grids is on a corner.
  const auto shares = even(0.05, 1.5, setup.coarse ? 7 : 50);
  for (const double start : {3.5, 60.5}) {
    for (const double delay : {0.0, 1.0}) {
      for (const double sigma : shares) {
        for (const double beta : shares) {
          cells.push_back({StabilityPart::kCycle, sigma, beta + delay, start, delay});
        }
      }
    }
  }
}

void add_edges(const StabilitySetup& setup, std::vector<StabilityCell>& cells) {
  const bool coarse = setup.coarse;
  for (const double delays : {0.0, 1.0}) {
    for (const double rate : octaves(250, 8000, coarse ? 3 : 11)) {
      const double period = static_cast<double>(to_ns(1 / rate)) * 1e-9;
      cells.push_back({StabilityPart::kRateEdge, 0, 0, period, delays * period});
    }
  }
  const double period = setup.period();
  for (const double delays : even(0, 5, coarse ? 3 : 21)) {
    cells.push_back({StabilityPart::kDelayEdge, 0, 0, period, delays * period});
  }
  for (const double share : even(0, 0.2, coarse ? 3 : 11)) {
    cells.push_back({StabilityPart::kLateEdge, share});
  }
  for (const double spread : even(0, 0.9, coarse ? 3 : 10)) {
    cells.push_back({StabilityPart::kSpreadEdge, spread});
  }
  for (const double step : octaves(3e-6, 3e-4, coarse ? 5 : 31)) {
    cells.push_back({StabilityPart::kStepEdge, step});
  }
}

}  // namespace

double cycle_speed(const StabilitySetup& setup, double counts) {
  return counts * kCycleStep * std::sqrt(kCycleStiffness / setup.arm.simulated.plant.mass);
}

std::vector<StabilityCell> stability_cells(const StabilitySetup& setup) {
  std::vector<StabilityCell> cells;
  add_maps(setup, cells);
  add_restitution(setup, cells);
  add_cycles(setup, cells);
  add_edges(setup, cells);
  add_drive_train_walls(setup, cells);
  return cells;
}

driver::Result<std::vector<double>> measure_stability(const StabilitySetup& setup,
                                                      const StabilityCell& cell) {
  switch (cell.part) {
    case StabilityPart::kLinearMap: {
      stability::WallCase wall = linear_case(setup);
      wall.stiffness = cell.a;
      wall.damping = cell.b;
      return alone(growth_rate(setup.arm, wall));
    }
    case StabilityPart::kArmMap: {
      stability::WallCase wall = arm_case(setup, setup.direction);
      wall.stiffness = cell.a;
      wall.damping = cell.b;
      return alone(arm_oscillation(setup, wall));
    }
    case StabilityPart::kLinearEdge: {
      stability::WallCase wall = linear_case(setup);
      wall.damping = cell.b;
      return alone(linear_edge(setup.arm, wall, kStiffnessMin, kStiffnessMax));
    }
    case StabilityPart::kArmEdge:
      return alone(arm_edge(setup, setup.direction, cell.b, false));
    case StabilityPart::kGuardedEdge:
      return alone(arm_edge(setup, setup.direction, cell.b, true));
    case StabilityPart::kDiagonalEdge:
      return alone(arm_edge(setup, setup.diagonal, cell.b, false));
    case StabilityPart::kRestitution: {
      stability::WallCase wall = linear_case(setup);
      wall.hand = {};
      wall.velocity_corner = 0;
      wall.stiffness = cell.a;
      wall.damping = cell.b;
      wall.period_ns = to_ns(cell.c);
      wall.delay_ns = to_ns(cell.d);
      const auto found = throw_at_wall(setup.arm, wall, setup.coarse ? 25 : 200);
      if (!found) return found.error();
      return std::vector<double>{found->mean, found->min, found->max};
    }
    case StabilityPart::kCycle:
      return alone(cycle(setup, cell));
    case StabilityPart::kRateEdge:
    case StabilityPart::kDelayEdge: {
      stability::WallCase wall = bare_case(setup);
      wall.period_ns = to_ns(cell.c);
      wall.delay_ns = to_ns(cell.d);
      return alone(edge_by_law(setup, wall, {.period = cell.c, .delay = cell.d}));
    }
    case StabilityPart::kLateEdge: {
      stability::WallCase wall = bare_case(setup);
      wall.gaps_ns = late_ticks(setup.period_ns, cell.a, kLatePeriods, 1);
      wall.duration = setup.coarse ? 8 : 20;
      return alone(edge_by_law(setup, wall, late_times(setup.period(), cell.a)));
    }
    case StabilityPart::kSpreadEdge: {
      stability::WallCase wall = bare_case(setup);
      wall.report_ns = setup.period_ns / 20;
      wall.gaps_ns = spread_ticks(setup.period_ns, cell.a, wall.report_ns, 1);
      wall.duration = setup.coarse ? 4 : 20;
      return alone(edge_by_law(setup, wall, spread_times(setup.period(), cell.a)));
    }
    case StabilityPart::kStepEdge:
      return alone(step_edge(setup, cell.a));
    case StabilityPart::kLagEdge:
    case StabilityPart::kCableEdge:
      return alone(drive_train_edge(setup, cell));
  }
  return std::vector<double>{};  // unreachable: a sweep rejects a cell without numbers
}

scene::LoopTimes late_times(double period, double share) {
  const double mean = period * (1 + share * kLatePeriods);
  const double spread = period * kLatePeriods * std::sqrt(share * (1 - share));
  return {.period = mean, .period_spread = spread};
}

scene::LoopTimes spread_times(double period, double spread) {
  // For a uniform distribution [derived: a uniform law of half width w has a standard deviation of
  // w / sqrt 3].
  return {.period = period, .period_spread = spread * period / std::sqrt(3.0)};
}

}  // namespace thimble::studies
