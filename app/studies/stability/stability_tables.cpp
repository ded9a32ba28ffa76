#include "studies/stability/stability_tables.h"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

#include "stability/stability_laws.h"
#include "studies/stability/drive_train_walls.h"

namespace thimble::studies {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

/// Returns the wall of the exact map, for the arm with the hand.
stability::SampledWall sampled(const StabilitySetup& setup, double damping) {
  const device_sim::PlantSettings& tip = setup.arm.simulated.plant;
  return {.mass = tip.mass + setup.hand.mass,
          .viscous = tip.viscous + setup.hand.damping,
          .hand_stiffness = setup.hand.stiffness,
          .damping = damping,
          .velocity_corner = setup.arm.velocity_corner_frequency,
          .period = setup.period(),
          .delay = setup.delay()};
}

/// Returns the free linear arm of case 1 [PHYSICS 7].
stability::SampledWall bare(const StabilitySetup& setup, double period, double delay) {
  return {.mass = setup.arm.simulated.plant.mass,
          .viscous = kBareDamping,
          .period = period,
          .delay = delay};
}

/// Returns the stiffness up to which an oscillation with the speed of a touch decays: dry friction
/// adds to the damping, (b + B + 4 c / (pi v)) / L [PHYSICS 1.4, solved for K].
double arm_law(const StabilitySetup& setup, double damping) {
  const device_sim::PlantSettings& tip = setup.arm.simulated.plant;
  const double coulomb = tip.coulomb * setup.direction.friction_share;
  const double held = 4 * coulomb / (std::numbers::pi * kReleaseSpeed);
  const double latency = scene::latency_of({.period = setup.period(), .delay = setup.delay()});
  return scene::stiffness_limit(tip.viscous + setup.hand.damping + damping + held, latency);
}

double step_law(const StabilitySetup& setup, double step) {
  return std::min(arm_law(setup, 0), 2 * setup.arm.simulated.plant.coulomb / step);
}

void add_laws(const StabilitySetup& setup, StabilityRow& row) {
  const StabilityCell& cell = row.cell;
  const scene::LoopTimes times{.period = cell.c, .delay = cell.d};
  row.law = row.exact = kNone;
  switch (cell.part) {
    case StabilityPart::kLinearEdge:
      row.exact = stability::stiffness_edge(sampled(setup, cell.b));
      row.law = scene::stiffness_limit(
          sampled(setup, 0).viscous + cell.b,
          scene::latency_of({.period = setup.period(), .delay = setup.delay()}));
      break;
    case StabilityPart::kArmEdge:
    case StabilityPart::kGuardedEdge:
    case StabilityPart::kDiagonalEdge:
      row.law = arm_law(setup, cell.b);
      break;
    case StabilityPart::kRestitution: {
      const device_sim::PlantSettings& tip = setup.arm.simulated.plant;
      row.law =
          stability::restitution(cell.a, tip.viscous + cell.b, tip.mass, scene::latency_of(times));
      break;
    }
    case StabilityPart::kRateEdge:
    case StabilityPart::kDelayEdge:
      row.law = scene::stiffness_limit(kBareDamping, scene::latency_of(times));
      row.exact = stability::stiffness_edge(bare(setup, cell.c, cell.d));
      break;
    case StabilityPart::kLateEdge:
      row.law = scene::stiffness_limit(kBareDamping,
                                       scene::latency_of(late_times(setup.period(), cell.a)));
      break;
    case StabilityPart::kSpreadEdge:
      row.law = scene::stiffness_limit(kBareDamping,
                                       scene::latency_of(spread_times(setup.period(), cell.a)));
      break;
    case StabilityPart::kStepEdge:
      row.law = step_law(setup, cell.a);
      break;
    case StabilityPart::kLagEdge:
    case StabilityPart::kCableEdge:
      row.law = stability::limit_by_phase(drive_train_wall(setup, cell));
      row.exact = stability::stiffness_edge(drive_train_wall(setup, cell));
      break;
    default:
      break;
  }
}

/// One CSV: its file, its heading, and its sweeps.
struct Table {
  const char* file;
  const char* heading;
  std::vector<StabilityPart> parts;
};

const std::vector<Table>& tables() {
  using enum StabilityPart;
  static const std::vector<Table> list{
      {"kb_map_linear.csv", "stiffness_N_m,damping_Ns_m,growth_1_s", {kLinearMap}},
      {"kb_map_arm.csv", "stiffness_N_m,damping_Ns_m,oscillation_m", {kArmMap}},
      {"kb_edge_linear.csv", "damping_Ns_m,stiffness_N_m,law_N_m,exact_N_m", {kLinearEdge}},
      {"kb_edge_arm.csv", "damping_Ns_m,stiffness_N_m,law_N_m", {kArmEdge}},
      {"kb_edge_with_energy_stage.csv", "damping_Ns_m,stiffness_N_m,law_N_m", {kGuardedEdge}},
      {"kb_edge_diagonal.csv", "damping_Ns_m,stiffness_N_m,law_N_m", {kDiagonalEdge}},
      {"restitution.csv",
       "period_s,delay_s,damping_Ns_m,stiffness_N_m,mean,least,most,law",
       {kRestitution}},
      {"limit_cycles.csv", "start_counts,delay_periods,sigma,beta,oscillation_counts", {kCycle}},
      {"stiffness_by_rate.csv", "period_s,delay_s,stiffness_N_m,law_N_m,exact_N_m", {kRateEdge}},
      {"stiffness_by_delay.csv", "period_s,delay_s,stiffness_N_m,law_N_m,exact_N_m", {kDelayEdge}},
      {"stiffness_by_late_ticks.csv", "late_share,stiffness_N_m,law_N_m", {kLateEdge}},
      {"stiffness_by_spread.csv", "spread_of_period,stiffness_N_m,law_N_m", {kSpreadEdge}},
      {"stiffness_by_encoder_step.csv", "step_m,stiffness_N_m,law_N_m", {kStepEdge}},
      {"stiffness_by_lag.csv", "lag_s,stiffness_N_m,law_N_m,exact_N_m", {kLagEdge}},
      {"stiffness_by_cable.csv",
       "cable_N_m,cable_damping_Ns_m,stiffness_N_m,law_N_m,exact_N_m",
       {kCableEdge}}};
  return list;
}

std::vector<double> columns(const StabilityRow& row) {
  const StabilityCell& c = row.cell;
  const double found = row.found.at(0);
  switch (c.part) {
    case StabilityPart::kLinearMap:
    case StabilityPart::kArmMap:
      return {c.a, c.b, found};
    case StabilityPart::kLinearEdge:
      return {c.b, found, row.law, row.exact};
    case StabilityPart::kArmEdge:
    case StabilityPart::kGuardedEdge:
    case StabilityPart::kDiagonalEdge:
      return {c.b, found, row.law};
    case StabilityPart::kRestitution:
      return {c.c, c.d, c.b, c.a, found, row.found.at(1), row.found.at(2), row.law};
    case StabilityPart::kCycle:
      return {c.c, c.d, c.a, c.b, found};
    case StabilityPart::kRateEdge:
    case StabilityPart::kDelayEdge:
      return {c.c, c.d, found, row.law, row.exact};
    case StabilityPart::kLateEdge:
    case StabilityPart::kSpreadEdge:
    case StabilityPart::kStepEdge:
      return {c.a, found, row.law};
    case StabilityPart::kLagEdge:
      return {c.a, found, row.law, row.exact};
    case StabilityPart::kCableEdge:
      return {c.a, c.b, found, row.law, row.exact};
  }
  return {};
}

std::string csv_line(const std::vector<double>& values) {
  std::string line;
  for (const double value : values) {
    line += fmt::format("{}{:.9g}", line.empty() ? "" : ",", value);
  }
  return line.append("\n");
}

/// Returns a text that identifies the wall of a row.
std::string place_of(const StabilityCell& c) {
  switch (c.part) {
    case StabilityPart::kLinearEdge:
    case StabilityPart::kArmEdge:
      return fmt::format("at B = {:.3g} N s/m", c.b);
    case StabilityPart::kRestitution:
      return fmt::format("at K = {:.3g} N/m, B = {:.3g} N s/m, {:.4g} Hz, {:.3g} ms late", c.a, c.b,
                         1 / c.c, 1e3 * c.d);
    case StabilityPart::kRateEdge:
    case StabilityPart::kDelayEdge:
      return fmt::format("at {:.4g} Hz, {:.3g} ms late", 1 / c.c, 1e3 * c.d);
    case StabilityPart::kLateEdge:
      return fmt::format("with {:.3g} % late ticks", 100 * c.a);
    case StabilityPart::kSpreadEdge:
      return fmt::format("with periods spread by {:.3g} %", 100 * c.a);
    case StabilityPart::kStepEdge:
      return fmt::format("with encoder steps of {:.3g} um", 1e6 * c.a);
    case StabilityPart::kLagEdge:
      return fmt::format("with an amplifier lag of {:.3g} ms", 1e3 * c.a);
    case StabilityPart::kCableEdge:
      return fmt::format("with a cable of {:.3g} N/m and {:.3g} N s/m", c.a, c.b);
    default:
      return {};
  }
}

/// The largest error of some rows, and its place; NaN if there are no rows.
struct WorstError {
  double error = kNone;
  bool unjudged = true;
  std::string note = "the law applies to no wall of this sweep, so nothing is compared";
};

double departure(double found, double law) {
  return std::abs(found / law - 1);
}

double shortfall(double found, double law) {
  return std::max(0.0, 1 - found / law);
}

/// Returns the largest error of the rows selected by `holds`.
template <class Holds>
WorstError worst_error(const std::vector<StabilityRow>& rows, double StabilityRow::*law,
                       const Holds& holds, double (*error_of)(double, double) = departure) {
  WorstError worst;
  for (const StabilityRow& row : rows) {
    if (!holds(row)) continue;
    const double error = error_of(row.found[0], row.*law);
    // A NaN error becomes the worst and remains it.
    if (!(error <= worst.error)) worst = {error, false, place_of(row.cell)};
    if (std::isnan(error)) break;
  }
  return worst;
}

constexpr auto kAll = [](const StabilityRow&) { return true; };

/// Agreement of the map of limit cycles with its corners: fractions of the cells that are at least
/// 5 % or 0.04 from a boundary. If more than one encoder steps, or against the friction of several
/// axes, sigma = 1/2 is a bound: only predicted rest is judged, not predicted flicker.
struct CycleAgreement {
  double growing = 0;  ///< Growth as predicted by the speed limit of an oscillation.
  double resting = 0;  ///< Of those that do not grow: rest or flicker as predicted by sigma = 1/2.
  double flicker = 0;  ///< Largest flicker where it is predicted, without a delay, counts.
};

CycleAgreement cycle_agreement(const StabilitySetup& setup, const std::vector<StabilityRow>& rows) {
  CycleAgreement agreement;
  double judged = 0, right = 0, settled = 0, classed = 0;
  const double period = setup.period();
  const bool lone = setup.direction.is_one_dimensional();
  for (const StabilityRow& row : rows) {
    const StabilityCell& cell = row.cell;
    const double viscous = cell.b * kCycleStiffness * period;
    const double coulomb = cell.a * kCycleStiffness * kCycleStep;
    const double latency = scene::latency_of({.period = period, .delay = cell.d * period});
    // Far from rest all axes slide, each with its own friction.
    const double limit = stability::oscillation_speed_limit(
        kCycleStiffness, viscous, coulomb * setup.direction.friction_share, latency);
    const double speed = cycle_speed(setup, cell.c);
    const double oscillation = row.found[0];
    const bool near_speed = std::abs(speed / limit - 1) < 0.1;
    // Below one step of speed per tick the describing function does not apply to the steps.
    if (near_speed || std::abs(cell.b - 0.5 - cell.d) < 0.04 || std::abs(cell.a - 0.5) < 0.04) {
      continue;
    }
    const bool grows = oscillation > 2.2 * cell.c;  // peak to peak, more than twice the start
    if (speed > limit || cell.a > 0.5) {
      ++judged;
      right += grows == (speed > limit) ? 1 : 0;
    }
    if (grows || speed > limit || cell.b < 0.7 + cell.d || oscillation > 6) continue;
    if (!lone && cell.a < 0.5) continue;
    ++settled;
    const bool rests = oscillation < 1e-4;
    classed += rests == (cell.a > 0.5) ? 1 : 0;
    if (cell.d == 0 && cell.a < 0.5) agreement.flicker = std::max(agreement.flicker, oscillation);
  }
  agreement.growing = judged > 0 ? right / judged : 0;
  agreement.resting = settled > 0 ? classed / settled : 0;
  return agreement;
}

}  // namespace

std::vector<StabilityRow> stability_rows(const StabilitySetup& setup, const CellNumbers& numbers) {
  const std::vector<StabilityCell> cells = stability_cells(setup);
  std::vector<StabilityRow> rows;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    rows.push_back({.cell = cells[i], .found = numbers.at(i)});
    add_laws(setup, rows.back());
  }
  return rows;
}

std::vector<StabilityRow> part_of(const std::vector<StabilityRow>& rows, StabilityPart part) {
  std::vector<StabilityRow> chosen;
  std::copy_if(rows.begin(), rows.end(), std::back_inserter(chosen),
               [part](const StabilityRow& row) { return row.cell.part == part; });
  return chosen;
}

ZWidth z_width(const std::vector<StabilityRow>& edge) {
  ZWidth width;
  for (std::size_t i = 0; i < edge.size(); ++i) {
    const double stiffness = edge[i].found[0];
    if (stiffness > width.stiffness_max) {
      width.stiffness_max = stiffness;
      width.damping_at = edge[i].cell.b;
    }
    if (i == 0) continue;
    width.area += 0.5 * (stiffness + edge[i - 1].found[0]) * (edge[i].cell.b - edge[i - 1].cell.b);
  }
  width.decades = width.stiffness_max > 0 ? std::log10(width.stiffness_max / kStiffnessJnd) : 0;
  return width;
}

driver::Result<void> write_stability_tables(const StabilitySetup&,
                                            const std::vector<StabilityRow>& rows,
                                            const std::filesystem::path& folder) {
  for (const Table& table : tables()) {
    std::string text = std::string(table.heading).append("\n");
    for (const StabilityPart part : table.parts) {
      for (const StabilityRow& row : part_of(rows, part)) text += csv_line(columns(row));
    }
    if (auto done = report::write_text(text, folder / table.file); !done) return done;
  }
  return {};
}

std::vector<session::Figure> stability_figures(const StabilitySetup& setup,
                                               const std::vector<StabilityRow>& rows) {
  std::vector<session::Figure> figures;
  const auto percent = [&figures](const std::string& name, double error, const char* goal,
                                  const std::string& note = {}) {
    figures.push_back({name, 100 * error, "%", goal, note});
  };
  // An error is judged only if there is one.
  const auto judge = [&percent](const std::string& name, const WorstError& worst,
                                const char* goal) {
    percent(name, worst.error, worst.unjudged ? "" : goal, worst.note);
  };
  const auto linear = part_of(rows, StabilityPart::kLinearEdge);
  const auto arm = part_of(rows, StabilityPart::kArmEdge);
  const auto diagonal = part_of(rows, StabilityPart::kDiagonalEdge);
  const ZWidth width = z_width(arm), diagonal_width = z_width(diagonal), ideal = z_width(linear);
  figures.push_back({"z_width.area", width.area, "N/m N s/m", ""});
  figures.push_back({"z_width.stiffness_max", width.stiffness_max, "N/m", ""});
  figures.push_back({"z_width.decades_above_jnd", width.decades, "log10(K_max/K_JND)", ""});
  const ZWidth guarded = z_width(part_of(rows, StabilityPart::kGuardedEdge));
  figures.push_back({"z_width.with_energy_stage.area", guarded.area, "N/m N s/m", ""});
  figures.push_back({"z_width.with_energy_stage.stiffness_max", guarded.stiffness_max, "N/m", ""});
  figures.push_back({"z_width.diagonal.area", diagonal_width.area, "N/m N s/m", ""});
  figures.push_back({"z_width.diagonal.stiffness_max", diagonal_width.stiffness_max, "N/m", ""});
  figures.push_back({"z_width.linear.area", ideal.area, "N/m N s/m", ""});
  figures.push_back({"z_width.linear.stiffness_max", ideal.stiffness_max, "N/m", ""});

  // Near its tip the region's edge is vertical: a small change of B is a large one of K.
  const double below_tip = 0.5 * ideal.damping_at;
  judge("agreement.edge_with_exact_map",
        worst_error(linear, &StabilityRow::exact,
                    [&](const StabilityRow& row) { return row.cell.b < below_tip; }),
        "<= 1");
  const double latency = scene::latency_of({.period = setup.period(), .delay = setup.delay()});
  const stability::SampledWall wall = sampled(setup, 0);
  judge("agreement.edge_with_latency_law",
        worst_error(linear, &StabilityRow::law,
                    [&](const StabilityRow& row) {
                      // The regime of the law [PHYSICS 1.1].
                      // A filtered velocity damps less than the law's B [PHYSICS 1.1].
                      return row.cell.b < 0.03 * wall.viscous &&
                             wall.viscous * setup.period() / wall.mass < 0.1 &&
                             row.law * latency * latency / wall.mass < 0.1;
                    }),
        "<= 5");
  judge("agreement.rate_with_law",
        worst_error(part_of(rows, StabilityPart::kRateEdge), &StabilityRow::law, kAll), "<= 3");
  judge("agreement.rate_with_exact_map",
        worst_error(part_of(rows, StabilityPart::kRateEdge), &StabilityRow::exact, kAll), "<= 1");
  judge("agreement.delay_with_law",
        worst_error(part_of(rows, StabilityPart::kDelayEdge), &StabilityRow::law, kAll), "<= 3");
  judge("agreement.late_ticks_with_law",
        worst_error(part_of(rows, StabilityPart::kLateEdge), &StabilityRow::law, kAll), "<= 3");
  judge("agreement.spread_with_law",
        worst_error(part_of(rows, StabilityPart::kSpreadEdge), &StabilityRow::law, kAll), "<= 3");
  for (const auto& [part, name] : {std::pair(StabilityPart::kLagEdge, "agreement.lag_with_"),
                                   {StabilityPart::kCableEdge, "agreement.cable_with_"}}) {
    const auto edges = part_of(rows, part);
    if (edges.empty()) continue;  // no joint of this arm moves the tip along a line by itself
    judge(std::string(name) + "law", worst_error(edges, &StabilityRow::law, kAll), "<= 5");
    judge(std::string(name) + "exact_map", worst_error(edges, &StabilityRow::exact, kAll), "<= 5");
  }
  const auto bounces = part_of(rows, StabilityPart::kRestitution);
  const auto soft = [&setup](const StabilityRow& row, bool damped) {
    const double l = row.cell.c / 2 + row.cell.d;
    // The law is for small damping: a wall that stops the mass within one oscillation behaves
    // differently.
    const double ratio = row.cell.b / (2 * std::sqrt(row.cell.a * setup.arm.simulated.plant.mass));
    return (row.cell.b > 0) == damped && ratio < 0.12 &&
           row.cell.a * l * l / setup.arm.simulated.plant.mass < 0.05;
  };
  judge("agreement.restitution_with_law",
        worst_error(bounces, &StabilityRow::law,
                    [&](const StabilityRow& row) { return soft(row, false); }),
        "<= 1");
  judge("agreement.restitution_of_damped_wall",
        worst_error(bounces, &StabilityRow::law,
                    [&](const StabilityRow& row) { return soft(row, true); }),
        "<= 5");
  const bool lone = setup.direction.is_one_dimensional();
  const std::string bound =
      lone ? ""
           : "several encoders or several axes with dry friction act along this direction, "
             "so the law of one dimension is only a bound";
  const CycleAgreement cycles = cycle_agreement(setup, part_of(rows, StabilityPart::kCycle));
  percent("agreement.limit_cycles_grow_as_predicted", cycles.growing, ">= 95");
  percent("agreement.limit_cycles_rest_as_predicted", cycles.resting, ">= 95",
          lone ? "" : bound + "; only walls that it predicts to rest are compared");
  figures.push_back({"limit_cycles.largest_flicker", cycles.flicker, "counts", "<= 2"});
  // A step of the motors' current is some percent of the holding force here.
  const auto steps = part_of(rows, StabilityPart::kStepEdge);
  judge("agreement.encoder_step_short_of_law",
        worst_error(steps, &StabilityRow::law, kAll, shortfall), "<= 10");
  const WorstError departs = worst_error(steps, &StabilityRow::law, kAll);
  percent("agreement.encoder_step_with_law", departs.error, lone ? "<= 10" : "",
          lone ? departs.note : bound);
  const WorstError arm_error =
      worst_error(arm, &StabilityRow::law, [](const StabilityRow& row) { return row.cell.b < 1; });
  percent("agreement.arm_edge_with_law", arm_error.error, "", arm_error.note);
  return figures;
}

}  // namespace thimble::studies
