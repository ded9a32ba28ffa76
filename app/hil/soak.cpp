#include "hil/soak.h"

#include <fmt/format.h>

#include <algorithm>

#include "bringup/identify/excitation.h"
#include "hil/heat_watch.h"

namespace thimble::hil {
namespace {

using Eigen::Vector3d;

constexpr const char* kName = "soak";
constexpr double kTick = 1e-3;        // s, of BenchArm
constexpr double kMissingMax = 0.05;  // of the ticks: possible without real-time priority

}  // namespace

HilResult check_soak(const HilRig& rig, double minutes) {
  auto opened = open_active(rig, TipHold::kFree);
  if (!opened) return broken_off(kName, opened.error().message, nullptr);
  bringup::BenchArm& bench = **opened;
  bringup::Excitation excitation(bench.device().state().p_WT, 1);
  const driver::WireCounters before = bench.device().wire_counters();
  const double begin = bench.now();
  double ticks = 0, moved = 0;
  const Vector3d p_start_W = bench.device().state().p_WT;
  bool left = false;
  HeatWatch heat(rig.file, bench);
  const auto law = [&](const driver::DeviceState& state) -> Vector3d {
    ++ticks;
    heat.tick(state);
    moved = std::max(moved, (state.p_WT - p_start_W).norm());
    left = left || !excitation.near(state.p_WT);
    if (left) return {0, 0, 0};
    return excitation.force(bench.now() - begin, kTick, state.p_WT, state.v_WT);
  };
  const bool whole = bench.run(60 * minutes, law, rig.stop);
  const driver::WireCounters after = bench.device().wire_counters();
  bench.device().deactivate();
  const double done = (bench.now() - begin) / 60;
  if (!whole)
    return broken_off(kName, fmt::format("The run ended after {:.1f} minutes.", done), &bench);
  const double missing = static_cast<double>(after.missing - before.missing) / ticks;
  std::vector<session::Figure> figures{
      {"soak_minutes", done, "min", "", ""},
      {"tip_moved", 1e3 * moved, "mm", "> 1", "if less, the tip is held or no motor pulls"},
      {"ticks_without_report", 100 * missing, "%", fmt::format("<= {:g}", 100 * kMissingMax), ""},
      {"reports_rejected", static_cast<double>(after.rejected - before.rejected), "", "== 0", ""},
      {"messages_refused", static_cast<double>(after.refused - before.refused), "", "== 0", ""},
      {"tip_left_its_place", left ? 1.0 : 0.0, "", "== 0", ""}};
  for (session::Figure& figure : heat.figures()) figures.push_back(std::move(figure));
  return judged(kName,
                fmt::format("The tip was pushed for {:.1f} minutes with up to {:g} N{}; {:.3f} % "
                            "of the ticks had no report.",
                            done, excitation.max_force(),
                            left ? ", until it left its allowed space" : "", 100 * missing) +
                    heat.text(),
                std::move(figures));
}

}  // namespace thimble::hil
