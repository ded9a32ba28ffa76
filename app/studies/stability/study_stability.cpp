#include "studies/stability/study_stability.h"

#include <fmt/core.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "log/logger.h"
#include "report/gnuplot.h"
#include "report/json_text.h"
#include "report/picture_style.h"
#include "studies/stability/stability_pictures.h"
#include "studies/stability/stability_tables.h"
#include "text_file.h"
#include "thimble/scene/build_info.h"

namespace thimble::studies {
namespace {

driver::Result<device_sim::HandSettings> hand_of(const StabilityOptions& options,
                                                 const scene::ArmFile& arm) {
  if (options.hand == "arm") return arm.simulated.hand;
  device_sim::HandSettings hand;
  if (options.hand == "none") return hand;
  const int read =
      std::sscanf(options.hand.c_str(), "%lf,%lf,%lf", &hand.mass, &hand.stiffness, &hand.damping);
  const bool good = read == 3 && hand.mass >= 0 && hand.stiffness >= 0 && hand.damping >= 0 &&
                    std::isfinite(hand.mass + hand.stiffness + hand.damping);
  if (!good) {
    return driver::Error{"--hand \"" + options.hand +
                         "\": expected arm, none, or MASS,STIFFNESS,DAMPING in kg, N/m, N s/m, for "
                         "example 0.025,300,3."};
  }
  return hand;
}

/// Writes the settings and the figures, as text and as JSON.
driver::Result<void> write_summary(const StabilitySetup& setup,
                                   const std::vector<session::Figure>& figures,
                                   const std::filesystem::path& folder) {
  nlohmann::ordered_json summary;
  const auto way = [](const stability::ArmDirection& d) {
    return nlohmann::ordered_json{{"direction", {d.n_W.x(), d.n_W.y(), d.n_W.z()}},
                                  {"encoder_step_m", d.step},
                                  {"one_dimensional", d.is_one_dimensional()}};
  };
  const device_sim::PlantSettings& tip = setup.arm.simulated.plant;
  summary["arm"] = setup.arm.name;
  summary["tip"] = {
      {"mass_kg", tip.mass}, {"viscous_Ns_m", tip.viscous}, {"coulomb_N", tip.coulomb}};
  summary["hand"] = {{"mass_kg", setup.hand.mass},
                     {"stiffness_N_m", setup.hand.stiffness},
                     {"damping_Ns_m", setup.hand.damping}};
  summary["loop"] = {{"period_s", setup.period()}, {"delay_s", setup.delay()}};
  summary["studied"] = way(setup.direction);
  summary["diagonal"] = way(setup.diagonal);
  for (const session::Figure& figure : figures) {
    auto& entry = summary["figures"][figure.name];
    entry["value"] = figure.value;
    entry["unit"] = figure.unit;
    if (!figure.note.empty()) entry["note"] = figure.note;
    if (figure.goal.empty()) continue;
    entry["goal"] = figure.goal;
    entry["met"] = figure.met();
  }
  return report::write_json(summary, folder / "summary.json");
}

}  // namespace

driver::Result<StabilitySetup> stability_setup(const StabilityOptions& options) {
  auto arm = scene::load_arm(options.arm_file);
  if (!arm) return arm.error();
  if (!arm->can_simulate) {
    return driver::Error{
        arm->name + ": the arm file has no section 'simulation'. Add it, or use another arm file."};
  }
  auto hand = hand_of(options, *arm);
  if (!hand) return hand.error();
  auto diagonal = stability::diagonal_direction_at_home(*arm);
  if (!diagonal) return diagonal.error();
  const auto& d = options.direction;
  auto direction = d.size() == 3 ? stability::direction_at_home(*arm, {d[0], d[1], d[2]})
                                 : stability::worst_direction_at_home(*arm);
  if (!direction) return direction.error();
  return StabilitySetup{.arm = std::move(arm).value(),
                        .hand = *hand,
                        .direction = *direction,
                        .diagonal = *diagonal,
                        .period_ns = std::llround(1e9 / options.rate),
                        .coarse = options.coarse};
}

driver::Result<StabilityReport> study_stability(const StabilityOptions& options,
                                                const SweepOptions& sweep_options,
                                                const std::atomic<bool>& stop) {
  const auto setup = stability_setup(options);
  if (!setup) return setup.error();
  const std::vector<StabilityCell> cells = stability_cells(*setup);
  const std::string choices =
      fmt::format("{:a} {} {:a} {:a} {:a}", options.rate, options.coarse ? 1 : 0,
                  setup->direction.n_W.x(), setup->direction.n_W.y(), setup->direction.n_W.z());
  const Sweep sweep{.name = "stability",
                    .key = scene::program_name() + "\n" + scene::text_of(options.arm_file) + "\n" +
                           options.hand + "\n" + choices,
                    .cells = cells.size(),
                    .measure = [&](std::size_t i) { return measure_stability(*setup, cells[i]); }};
  const auto result = run_sweep(sweep, sweep_options, stop);
  if (!result) return result.error();
  StabilityReport report{result->end, {}};
  if (report.end != SweepEnd::kDone) return report;

  const std::filesystem::path& folder = sweep_options.folder;
  const auto rows = stability_rows(*setup, result->numbers);
  report.figures = stability_figures(*setup, rows);
  if (auto made = report::make_picture_folder(folder); !made) return made.error();
  if (auto done = write_stability_tables(*setup, rows, folder); !done) return done.error();
  if (auto done = write_summary(*setup, report.figures, folder); !done) return done.error();
  if (!report::has_gnuplot()) {
    scene::logger().warn(
        "NO PICTURES: gnuplot is not installed (apt install gnuplot-nox). Tables and figures are "
        "complete.");
    return report;
  }
  if (auto done = draw_stability(*setup, rows, folder); !done) return done.error();
  return report;
}

}  // namespace thimble::studies
