#include "hil/hil_suite.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <string>
#include <utility>

#include "bringup/listen.h"
#include "hil/cable_pull.h"
#include "hil/check_watchdog.h"
#include "hil/constants_check.h"
#include "hil/friction_at_rest.h"
#include "hil/known_places.h"
#include "hil/soak.h"
#include "hil/tied_spring.h"
#include "hil/wall_check.h"

namespace thimble::hil {
namespace {

constexpr double kHourOfFull = 60, kMinutesOfQuick = 0.5;
constexpr int kOpened = 3;  // a wire that is not closed properly shows when it is reopened

/// Returns what was heard after each opening of the arm; equal texts once.
std::string text_of_openings(const std::vector<std::string>& texts) {
  const bool equal = std::all_of(texts.begin(), texts.end(),
                                 [&](const std::string& text) { return text == texts.front(); });
  if (equal) return "Opened three times, each with the same result: " + texts.front();
  std::string all = "Opened three times:";
  for (const std::string& text : texts) all += ' ' + text;
  return all;
}

HilResult check_reports(const HilRig& rig, double seconds) {
  constexpr const char* kName = "reports";
  std::vector<std::string> texts;
  std::vector<session::Figure> figures;
  for (int i = 1; i <= kOpened; ++i) {
    auto bench = rig.open(TipHold::kFree);
    if (!bench) return broken_off(kName, bench.error().message, nullptr);
    const bringup::ReportStatistics heard = bringup::listen(**bench, seconds, rig.stop);
    if (!heard.whole) return broken_off(kName, heard.text(), bench->get());
    texts.push_back(heard.text());
    figures.push_back({fmt::format("reports_are_good_{}", i), heard.good() ? 1.0 : 0.0, "", "== 1",
                       heard.text()});
  }
  return judged(kName, text_of_openings(texts), std::move(figures));
}

HilResult check_feel(const HilRig& rig, const HilOptions& options) {
  constexpr const char* kName = "feel_check";
  if (!rig.attended) {
    return judged(
        kName,
        options.checked
            ? "This arm has already passed its feel check with this arm file."
            : "This arm has not passed its feel check with this arm file, so no check may apply "
              "force. Run `thimble feel-check`, or run this command with --attended.",
        {{"passed_before", options.checked ? 1.0 : 0.0, "", "== 1", ""}});
  }
  auto bench = rig.open(TipHold::kHand);
  if (!bench) return broken_off(kName, bench.error().message, nullptr);
  constexpr double kReleased = 0.1;  // N
  const bringup::Question hand = [&](const std::string&) {
    return (*bench)->true_force() < kReleased;
  };
  const auto results =
      bringup::feel_check(**bench, rig.file, rig.prompt, rig.stop,
                          rig.question || !(*bench)->simulated() ? rig.question : hand);
  std::string text;
  std::size_t passed = 0;
  for (const bringup::CheckResult& one : results) {
    passed += one.passed ? 1 : 0;
    if (!one.passed) text += (text.empty() ? "" : " ") + one.name + ": " + one.text;
  }
  if (text.empty())
    text = fmt::format("{} of {} steps passed.", passed, bringup::feel_checks(rig.file));
  HilResult result = judged(kName, text,
                            {{"steps_passed", static_cast<double>(passed), "",
                              fmt::format("== {}", bringup::feel_checks(rig.file)), ""}});
  return result;
}

constexpr const char* kFeelCheck = "feel_check";

/// A check of the suite.
struct Check {
  const char* name;
  bool pushes;  ///< It applies forces, so the arm must have passed its feel check.
  std::function<HilResult(const HilRig&, const HilOptions&)> run;
};

double minutes_of_soak(const HilOptions& options) {
  if (options.soak_minutes > 0) return options.soak_minutes;
  return options.full ? kHourOfFull : kMinutesOfQuick;
}

const std::vector<Check>& all_checks() {
  using Rig = const HilRig&;
  using Options = const HilOptions&;
  static const std::vector<Check> kChecks{
      {"reports", false, [](Rig rig, Options o) { return check_reports(rig, o.full ? 10 : 2); }},
      {kFeelCheck, false, [](Rig rig, Options o) { return check_feel(rig, o); }},
      {"home_pose", false, [](Rig rig, Options) { return check_home_pose(rig); }},
      {"known_length", false,
       [](Rig rig, Options o) { return check_known_length(rig, o.known_length); }},
      {"constants", true, [](Rig rig, Options o) { return check_constants(rig, o); }},
      {"watchdog", true, [](Rig rig, Options) { return check_watchdog_time(rig); }},
      {"friction_at_rest", true, [](Rig rig, Options) { return check_friction_at_rest(rig); }},
      {"stiffest_wall", true, [](Rig rig, Options o) { return check_stiffest_wall(rig, o.full); }},
      {"force_accuracy", true, [](Rig rig, Options o) { return check_tied_spring(rig, o.spring); }},
      {"soak", true, [](Rig rig, Options o) { return check_soak(rig, minutes_of_soak(o)); }},
      {"cable_pull", true, [](Rig rig, Options o) { return check_cable_pull(rig, o.replug); }}};
  return kChecks;
}

std::vector<Check> chosen(const HilOptions& options) {
  if (options.only.empty()) return all_checks();
  const auto named = [&](const Check& check) {
    return std::find(options.only.begin(), options.only.end(), check.name) != options.only.end();
  };
  const bool pushes = std::any_of(all_checks().begin(), all_checks().end(),
                                  [&](const Check& check) { return check.pushes && named(check); });
  std::vector<Check> found;
  for (const Check& check : all_checks()) {
    if (named(check) || (pushes && check.name == std::string(kFeelCheck))) found.push_back(check);
  }
  return found;
}

std::vector<std::string> names_of(const std::vector<Check>& checks) {
  std::vector<std::string> names;
  for (const Check& check : checks) names.emplace_back(check.name);
  return names;
}

}  // namespace

std::vector<std::string> hil_checks() {
  return names_of(all_checks());
}

std::vector<std::string> chosen_checks(const HilOptions& options) {
  return names_of(chosen(options));
}

std::vector<HilResult> with_not_run(std::vector<HilResult> results, const HilOptions& options,
                                    const std::string& why) {
  const std::vector<std::string> names = chosen_checks(options);
  for (std::size_t i = results.size(); i < names.size(); ++i) {
    results.push_back(not_run(names[i], why));
  }
  return results;
}

std::vector<HilResult> run_hil_suite(const HilRig& rig, const HilOptions& options,
                                     const HilListener& listener) {
  std::vector<HilResult> results;
  std::string no_push;  // reason why no force may be applied
  const std::vector<Check> checks = chosen(options);
  for (const Check& check : checks) {
    if (rig.stop.load()) break;
    if (listener.begun) listener.begun(check.name, results.size() + 1, checks.size());
    const auto begin = std::chrono::steady_clock::now();
    HilResult result =
        check.pushes && !no_push.empty() ? not_run(check.name, no_push) : check.run(rig, options);
    if (rig.stop.load()) break;  // the result of an interrupted check is not used
    result.seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const bool by_name =
        std::find(options.only.begin(), options.only.end(), check.name) != options.only.end();
    if (by_name && result.outcome == HilOutcome::kSkipped) {
      result = not_run(result.name, result.text + " It was requested by name.");
    }
    if (no_push.empty() && result.unsafe) {
      no_push = "The check " + result.name + " was aborted, so no later check may apply force.";
    } else if (no_push.empty() && check.name == std::string(kFeelCheck) &&
               result.outcome != HilOutcome::kPassed) {
      no_push = "The arm has not passed its feel check.";
    }
    results.push_back(std::move(result));
    if (listener.ended) listener.ended(results);
  }
  return with_not_run(std::move(results), options, "The run was stopped before this check ended.");
}

}  // namespace thimble::hil
