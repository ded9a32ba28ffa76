#include "hil/hil_suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "bringup/identify/simulated_bench.h"
#include "bringup/listen.h"
#include "hil/cable_pull.h"
#include "hil/constants_check.h"
#include "hil/edge_of_wall.h"
#include "hil/friction_at_rest.h"
#include "hil/soak.h"
#include "hil/tied_spring.h"
#include "hil/watchdog_time.h"

namespace thimble::app {
namespace {

constexpr double kHourOfFull = 60, kMinutesOfQuick = 0.5;
constexpr int kOpened = 3;  // a wire that is not closed properly shows when it is opened again

HilResult check_reports(const HilRig& rig, double seconds) {
  constexpr const char* kName = "reports";
  std::string text;
  std::vector<Figure> figures;
  for (int i = 1; i <= kOpened; ++i) {
    auto bench = rig.open(TipHold::kFree);
    if (!bench) return broken_off(kName, bench.error().message, nullptr);
    const Listened heard = listen(**bench, seconds, rig.stop);
    if (!heard.whole) return broken_off(kName, heard.text(), bench->get());
    text += (text.empty() ? "" : " ") + heard.text();
    figures.push_back({fmt::format("reports_are_good_{}", i), heard.good() ? 1.0 : 0.0, "", "== 1",
                       heard.text()});
  }
  return judged(kName, "Opened three times: " + text, std::move(figures));
}

HilResult check_feel(const HilRig& rig, const HilOptions& options) {
  constexpr const char* kName = "feel_check";
  if (!rig.told) {
    return judged(kName,
                  options.checked
                      ? "This arm, as it is, has passed its feel check before."
                      : "This arm, with this arm file, has not passed its feel check: run `thimble "
                        "feel-check`, or this with --attended. Nothing pushes before that.",
                  {{"passed_before", options.checked ? 1.0 : 0.0, "", "== 1", ""}});
  }
  auto bench = rig.open(TipHold::kHand);
  if (!bench) return broken_off(kName, bench.error().message, nullptr);
  const auto results = feel_check(**bench, rig.file, rig.prompt, rig.stop);
  std::string text;
  std::size_t passed = 0;
  for (const CheckResult& one : results) {
    passed += one.passed ? 1 : 0;
    if (!one.passed) text += (text.empty() ? "" : " ") + one.name + ": " + one.text;
  }
  if (text.empty()) text = fmt::format("{} of {} steps passed.", passed, kFeelChecks);
  HilResult result = judged(
      kName, text,
      {{"steps_passed", static_cast<double>(passed), "", fmt::format("== {}", kFeelChecks), ""}});
  return result;
}

HilResult check_edge(const HilRig& rig, bool full) {
  constexpr const char* kName = "stiffest_wall";
  EdgeSearch search;
  if (!full) search.factor = 1.1;
  const double law = edge_by_law(rig.file, search.speed);
  search.first = std::max(20.0, 0.25 * law);
  auto twin_bench = simulated_bench(rig.file, 0);
  if (!twin_bench) return broken_off(kName, twin_bench.error().message, nullptr);
  const auto twin = find_edge_of_wall(**twin_bench, rig.file, search, rig.stop);
  if (!twin) {
    return skipped(kName,
                   "The simulated arm of the file carries no such wall, so there is nothing "
                   "to compare with: " +
                       twin.error().message);
  }
  auto bench = rig.open(TipHold::kFree);
  if (!bench) return broken_off(kName, bench.error().message, nullptr);
  const auto found = find_edge_of_wall(**bench, rig.file, search, rig.stop);
  if (!found) return broken_off(kName, found.error().message, bench->get());
  // A step of the search, and what mass and friction may differ by.
  constexpr double kAllowed = 0.25;
  const double ratio = found->stiffness / twin->stiffness;
  return judged(
      kName,
      fmt::format(
          "The stiffest wall that gives a tip at {2:g} mm/s no energy has {0}{1:.0f} N/m; with the "
          "simulated arm of the file {3}{4:.0f}, by the law {5:.0f}.",
          found->grew ? "" : "at least ", found->stiffness, 1e3 * search.speed,
          twin->grew ? "" : "at least ", twin->stiffness, law),
      {{"stiffest_wall", found->stiffness, "N/m", "", ""},
       {"stiffest_wall_by_law", law, "N/m", "", ""},
       {"stiffest_wall_of_twin", twin->stiffness, "N/m", "", ""},
       {"wall_over_twin", ratio, "", fmt::format(">= {:g}", 1 - kAllowed), ""},
       {"wall_over_twin_above", ratio, "", fmt::format("<= {:g}", 1 / (1 - kAllowed)),
        "the same, from above"},
       {"energy_given", 1e3 * found->given_most, "mJ", "", "by the wall that gave most"},
       {"force_most", found->force_most, "N", fmt::format("<= {:g}", kHilForceMax), ""}});
}

}  // namespace

std::vector<HilResult> run_hil_suite(const HilRig& rig, const HilOptions& options,
                                     const HilListener& listener) {
  std::vector<HilResult> results;
  bool may_push = true;
  std::string why_not;
  const auto take = [&](const std::function<HilResult()>& check, const char* pushes) {
    if (rig.stop.load()) return;
    const auto begin = std::chrono::steady_clock::now();
    HilResult result = pushes != nullptr && !may_push ? skipped(pushes, why_not) : check();
    if (rig.stop.load()) return;  // what was interrupted says nothing
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (may_push && result.unsafe) {
      may_push = false;
      why_not = "The check " + result.name + " was broken off, so nothing pushes any more.";
    }
    results.push_back(std::move(result));
    listener(results.back());
  };
  take([&] { return check_reports(rig, options.full ? 10 : 2); }, nullptr);
  take([&] { return check_feel(rig, options); }, nullptr);
  if (!results.empty() && results.back().outcome != HilOutcome::kPassed && may_push) {
    may_push = false;
    why_not = "The arm has not passed its feel check.";
  }
  take([&] { return check_constants(rig, options.full ? 60 : 15); }, "constants");
  take([&] { return check_watchdog_time(rig); }, "watchdog");
  take([&] { return check_friction_at_rest(rig); }, "friction_at_rest");
  take([&] { return check_edge(rig, options.full); }, "stiffest_wall");
  take([&] { return check_tied_spring(rig, options.spring); }, "force_accuracy");
  const double minutes = options.soak_minutes > 0 ? options.soak_minutes
                         : options.full           ? kHourOfFull
                                                  : kMinutesOfQuick;
  take([&] { return check_soak(rig, minutes); }, "soak");
  take([&] { return check_cable_pull(rig, options.replug); }, "cable_pull");
  return results;
}

}  // namespace thimble::app
