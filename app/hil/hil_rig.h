#pragma once

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "bringup/bench_arm.h"
#include "bringup/feel_check.h"
#include "report/figure_output.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::hil {

/// Max. force that any check requests, N; the gate cuts larger ones.
inline constexpr double kHilForceMax = 1.0;

/// Hold of the tip during a check.
enum class TipHold {
  kFree,    ///< None: the arm carries itself, and no hand is on the grip.
  kSpring,  ///< The spring of known stiffness that the user tied to it.
  kHand,    ///< A hand that follows the prompts of the feel check.
  kHome,    ///< A hand that brings it to its home pose from two sides.
  kLength,  ///< A hand that moves it by a known length along each axis.
  kMass,    ///< None, with the known mass fixed to it.
};

/// Options of the checks.
struct HilOptions {
  bool full = false;      ///< Longer, with finer steps of the wall.
  bool attended = false;  ///< A user answers prompts.
  /// The arm has passed its feel check in its present state. Without that no force is applied,
  /// unless it passes one now.
  bool checked = false;
  bool replug = false;  ///< A user pulls the cable and plugs it in again.
  double spring = 0;    ///< Stiffness of the spring tied to the tip, N/m; 0: none.
  /// Duration of the soak, minutes; 0: half a minute, or an hour in the full suite.
  double soak_minutes = 0;
  double known_mass = 0;  ///< Mass that a user fixes to the tip, kg; 0: none (see IdentifyOptions).
  /// Distance from mark to mark by which a user moves the tip, m; 0: none.
  double known_length = 0;
  /// Names of the checks to run (`hil_checks`); empty: all. A check that applies forces also
  /// selects the feel check.
  std::vector<std::string> only{};
};

/// Environment of a check: the arm, opened again for each check.
struct HilRig {
  using Open = std::function<driver::Result<std::unique_ptr<bringup::BenchArm>>(TipHold hold)>;

  const scene::ArmFile& file;
  Open open;
  const std::atomic<bool>& stop;
  bringup::Prompt prompt;        ///< Asks the user to act; returns false to skip the check.
  bringup::Question question{};  ///< Asks the user yes or no; empty: the simulated hand answers.
  bool attended = false;         ///< A user or a simulated hand is present.
};

/// Opens the simulated arm of a file as a check needs it: free, tied to a spring (N/m), or held by
/// a hand that follows the prompts. Real-time: never from the servo thread.
driver::Result<std::unique_ptr<bringup::BenchArm>> open_simulated(const scene::ArmFile& file,
                                                                  const HilOptions& options,
                                                                  TipHold hold);

/// Opens the arm for a check, activates it, and waits with zero force until the soft start is over.
driver::Result<std::unique_ptr<bringup::BenchArm>> open_active(const HilRig& rig, TipHold hold);

/// Outcome of a check.
enum class HilOutcome {
  kPassed,
  kFailed,
  kSkipped,  ///< Does not apply to this arm, or was not requested.
  kNotRun,   ///< Should have run but did not: stopped, out of time, or not safe.
};

/// Words for an outcome.
struct HilOutcomeWords {
  HilOutcome outcome;
  const char* in_files;     ///< In JSON.
  const char* on_terminal;  ///< At most 7 characters.
};

/// Words for all outcomes.
inline constexpr std::array<HilOutcomeWords, 4> kHilOutcomeWords{{
    {HilOutcome::kPassed, "passed", "ok"},
    {HilOutcome::kFailed, "failed", "FAILED"},
    {HilOutcome::kSkipped, "skipped", "skipped"},
    {HilOutcome::kNotRun, "not_run", "NOT RUN"},
}};

/// Returns the words for an outcome.
constexpr const HilOutcomeWords& words_of(HilOutcome outcome) {
  for (const HilOutcomeWords& words : kHilOutcomeWords) {
    if (words.outcome == outcome) return words;
  }
  return kHilOutcomeWords.back();
}

/// Result of a check.
struct HilResult {
  std::string name;  ///< In lower_snake_case.
  HilOutcome outcome = HilOutcome::kSkipped;
  std::string text;  ///< One or more sentences.
  std::vector<session::Figure> figures;
  double seconds = 0;  ///< Wall-clock duration, s.
  /// Aborted by a fault of the device, or by a motor that pulls in the wrong direction. No force
  /// may be applied after it.
  bool unsafe = false;
  bool fault = false;  ///< Aborted by a fault of the device.
};

/// Lists the properties of an arm that a suite with these results did not test, a sentence each:
/// those that motion cannot show, and the means that can.
std::vector<std::string> not_tested(const scene::ArmFile& file, const HilOptions& options,
                                    const std::vector<HilResult>& results);

/// Returns the result of a skipped check, with the reason.
inline HilResult skipped(std::string name, std::string why) {
  return {std::move(name), HilOutcome::kSkipped, std::move(why), {}, 0, false, false};
}

/// Returns the result of a check that should have run but did not, with the reason.
inline HilResult not_run(std::string name, std::string why) {
  return {std::move(name), HilOutcome::kNotRun, std::move(why), {}, 0, false, false};
}

/// Returns the result of a check that ended without a measurement: its error, and the device's
/// fault if that was the reason.
HilResult broken_off(std::string name, const std::string& why, const bringup::BenchArm* bench);

/// Returns the result of a check, which passed if all figures meet their goals.
HilResult judged(std::string name, std::string text, std::vector<session::Figure> figures);

}  // namespace thimble::hil
