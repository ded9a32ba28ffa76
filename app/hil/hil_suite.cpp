#include "hil/hil_suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <utility>

#include "bringup/listen.h"
#include "hil/cable_pull.h"
#include "hil/constants_check.h"
#include "hil/friction_at_rest.h"
#include "hil/soak.h"
#include "hil/tied_spring.h"
#include "hil/wall_check.h"
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
  take([&] { return check_stiffest_wall(rig, options.full); }, "stiffest_wall");
  take([&] { return check_tied_spring(rig, options.spring); }, "force_accuracy");
  const double minutes = options.soak_minutes > 0 ? options.soak_minutes
                         : options.full           ? kHourOfFull
                                                  : kMinutesOfQuick;
  take([&] { return check_soak(rig, minutes); }, "soak");
  take([&] { return check_cable_pull(rig, options.replug); }, "cable_pull");
  return results;
}

}  // namespace thimble::app
