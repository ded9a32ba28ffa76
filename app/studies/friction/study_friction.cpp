#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <system_error>

#include "log/logger.h"
#include "log/printed_text.h"
#include "log/progress.h"
#include "report/gnuplot.h"
#include "report/picture_style.h"
#include "stability/signal.h"
#include "studies/friction/friction_cases.h"
#include "studies/friction/friction_pictures.h"
#include "studies/friction/study_friction.h"
#include "surface/friction/friction_settings.h"

namespace thimble::studies {
namespace {

constexpr int kDelays = 4;                  // 0 to 3 ticks
constexpr std::size_t kWorstStopSteps = 4;  // its time relative to that of a case [chosen]
constexpr int kStops = 40;                  // positions within one count [PHYSICS 7, case 14]

std::string table_row(const FrictionCase& which, const FrictionMeasures& found) {
  return fmt::format(
      "{:<3} {:<31} {:7.4f} {:7.2f} {:5.0f} {:6.3f}   {:7.4f} {:6.3f} {:6.3f}   {:7.4f}\n",
      which.letter, which.title, found.rest_force, 1e6 * found.rest_way, found.rest_frequency,
      found.rest_held, found.creep_force, found.creep_mean, found.slow_mean, found.tremor_force);
}

std::string csv_row(const FrictionCase& which, int delay, const FrictionMeasures& found) {
  return fmt::format("{},{},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g},{:.9g}\n", which.name,
                     delay, found.rest_force, found.rest_way, found.rest_frequency, found.rest_held,
                     found.creep_force, found.creep_mean, found.slow_mean, found.tremor_force);
}

/// The worst of 40 stops at each of four delays.
struct WorstStop {
  double force = 0;         // N RMS above 50 Hz
  double way = 0;           // m RMS above 50 Hz
  double sign_changes = 0;  // 1/s
  double min_held = HUGE_VAL;
};

WorstStop worst_stop(const FrictionCase& which) {
  WorstStop worst;
  for (int delay = 0; delay < kDelays; ++delay) {
    stability::FrictionRigSettings rig;
    rig.delay_ns = delay * rig.period_ns;
    for (int i = 0; i < kStops; ++i) {
      const stability::RigRun run =
          stop_run(which, rig, kStopPlace + i * rig.encoder_step / kStops);
      const std::vector<double> force = stability::high_passed(run.force, 1000, 50);
      const std::vector<double> way = stability::high_passed(run.x, 1000, 50);
      const std::span<const double> rest = std::span(run.force).last(1000);
      worst.force = std::max(worst.force, stability::root_mean_square(std::span(force).last(1000)));
      worst.way = std::max(worst.way, stability::root_mean_square(std::span(way).last(1000)));
      worst.sign_changes =
          std::max(worst.sign_changes, stability::sign_changes_per_second(rest, 1000));
      worst.min_held = std::min(worst.min_held, std::abs(stability::mean(rest)));
    }
  }
  return worst;
}

/// Adds the naive law's mean and ripple with their closed forms [PHYSICS 2.1].
void add_even_sliding(std::vector<session::Figure>& figures) {
  for (const double speed : {0.005, 0.02}) {
    const stability::FrictionRigSettings rig;
    const EvenSliding found = slide_evenly(rig, speed);
    const double p = speed * static_cast<double>(rig.period_ns) * 1e-9 / rig.encoder_step;
    const double mean_law = p * 0.5;
    const double ripple_law = 0.5 * std::sqrt(p * (1 - p));
    const std::string at = "naive.slide_" + std::to_string(std::lround(1e3 * speed)) + "mm_s.";
    figures.push_back({at + "mean", found.mean, "N", ""});
    figures.push_back({at + "mean_error", std::abs(found.mean / mean_law - 1), "", "<= 0.01"});
    figures.push_back({at + "ripple", found.ripple, "N", ""});
    figures.push_back(
        {at + "ripple_error", std::abs(found.ripple / ripple_law - 1), "", "<= 0.01"});
  }
}

void add_measures(std::vector<session::Figure>& figures, const FrictionCase& which,
                  const FrictionMeasures& found) {
  const std::string name = which.name + ".";
  // The guarantees of the default, and the limit cycle of the paper's friction [PHYSICS 2.2 and 7,
  // cases 14, 15].
  const bool chosen = which.name == "bristle";
  figures.push_back({name + "rest_force", found.rest_force, "N", chosen ? "<= 0.001" : ""});
  figures.push_back({name + "rest_way", found.rest_way, "m", chosen ? "<= 5e-08" : ""});
  figures.push_back({name + "rest_frequency", found.rest_frequency, "Hz", chosen ? "== 0" : ""});
  figures.push_back({name + "rest_held", found.rest_held, "N", ""});
  figures.push_back({name + "creep_force", found.creep_force, "N", chosen ? "<= 0.005" : ""});
  figures.push_back({name + "creep_mean", found.creep_mean, "N", chosen ? ">= 0.45" : ""});
  figures.push_back({name + "slow_mean", found.slow_mean, "N", chosen ? ">= 0.45" : ""});
  figures.push_back({name + "tremor_force", found.tremor_force, "N", ""});
  if (which.name == "naive_hold") {
    figures.push_back(
        {name + "rest_force_against_0.49_N", std::abs(found.rest_force / 0.49 - 1), "", "<= 0.2"});
    figures.push_back(
        {name + "rest_way_against_15.6_um", std::abs(found.rest_way / 15.6e-6 - 1), "", "<= 0.2"});
  }
}

}  // namespace

driver::Result<std::vector<session::Figure>> study_friction(const std::filesystem::path& folder) {
  if (auto made = report::make_picture_folder(folder); !made) return made.error();
  std::vector<session::Figure> figures;
  std::vector<FrictionMeasures> undelayed;
  std::string csv =
      "friction,delay_ticks,rest_force_N,rest_way_m,rest_frequency_Hz,rest_held_N,creep_force_N,"
      "creep_mean_N,slow_mean_N,tremor_force_N\n";
  scene::print_format(
      "Friction of 0.5 N under a load of 1 N, through the wire: vintage arm, encoder "
      "step 0.03 mm, 1 kHz, pinch grip.\nForces (N) and paths (um) are RMS above 50 "
      "Hz; stop from 50 mm/s, creep at 1 mm/s, slow at 5 mm/s,\ntremor of 300 "
      "um.\n\n                                    after a stop                  "
      "creep    mean   slow    tremor\n    friction                          force   "
      " path    Hz   held     force   mean   mean     force\n");
  scene::Progress progress("study friction");
  const std::size_t all = friction_cases().size() * kDelays + kWorstStopSteps;
  std::size_t measured = 0;
  for (const FrictionCase& which : friction_cases()) {
    for (int delay = 0; delay < kDelays; ++delay) {
      stability::FrictionRigSettings rig;
      rig.delay_ns = delay * rig.period_ns;
      FrictionMeasures found = measure(which, rig);
      csv += csv_row(which, delay, found);
      progress.set_share(++measured, all);
      if (delay > 0) continue;
      scene::print_format("%s", table_row(which, found).c_str());
      add_measures(figures, which, found);
      undelayed.push_back(std::move(found));
    }
  }
  scene::print_format("\n");
  add_even_sliding(figures);

  stability::FrictionRigSettings ideal;
  ideal.encoder_step = 0;
  const FrictionMeasures smooth = measure(friction_cases()[1], ideal);
  figures.push_back({"naive_hold.ideal_encoder.rest_way", smooth.rest_way, "m", "<= 1e-06"});
  const auto chosen =
      std::find_if(friction_cases().begin(), friction_cases().end(),
                   [](const FrictionCase& which) { return which.name == "bristle"; });
  const WorstStop worst = worst_stop(*chosen);
  progress.set_share(1.0);
  figures.push_back({"bristle.worst_of_160_stops.force", worst.force, "N", "<= 0.001"});
  figures.push_back({"bristle.worst_of_160_stops.way", worst.way, "m", "<= 5e-08"});
  figures.push_back({"bristle.worst_of_160_stops.sign_changes", worst.sign_changes, "1/s", "== 0"});
  figures.push_back({"bristle.worst_of_160_stops.min_held", worst.min_held, "N", ">= 0.25"});

  if (auto done = report::write_text(csv, folder / "friction.csv"); !done) return done.error();
  if (!report::has_gnuplot()) {
    scene::logger().warn(
        "NO PICTURES: gnuplot is not installed (apt install gnuplot-nox). Table, CSV "
        "file and figures are complete.");
    return figures;
  }
  for (std::size_t i = 0; i < undelayed.size(); ++i) {
    if (auto done = draw_friction(friction_cases()[i], undelayed[i], folder); !done) {
      return done.error();
    }
  }
  if (auto done = draw_friction_overview(undelayed, folder); !done) return done.error();
  return figures;
}

}  // namespace thimble::studies
