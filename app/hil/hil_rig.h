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

/// The most that any check asks an arm for, N; the gate cuts what is above.
inline constexpr double kHilForceMax = 1.0;

/// What holds the tip during a check.
enum class TipHold {
  kFree,    ///< Nothing: the arm stands by itself, and no hand is on the grip.
  kSpring,  ///< The spring of known stiffness that the user tied to it.
  kHand,    ///< A hand that does what the prompts of the feel check ask.
  kHome,    ///< A hand that brings it into its home pose from two sides.
  kLength,  ///< A hand that moves it by a known length along each axis.
  kMass,    ///< Nothing, with the known mass fixed to it.
};

/// How an arm is checked.
struct HilOptions {
  bool full = false;      ///< Longer, and finer steps of the wall.
  bool attended = false;  ///< A person answers prompts.
  /// The arm, as it is, has passed its feel check; without that nothing pushes, unless it passes
  /// one now.
  bool checked = false;
  bool replug = false;      ///< A person pulls the cable and plugs it in again.
  double spring = 0;        ///< Stiffness of the spring tied to the tip, N/m; 0: none.
  double soak_minutes = 0;  ///< Of the soak; 0: half a minute, or an hour of the full suite.
  double known_mass = 0;    ///< See IdentifyOptions; a person fixes it to the tip.
  double known_length = 0;  ///< From mark to mark, m; a person moves the tip by it; 0: none.
  /// Names of the checks that run (`hil_checks`); empty: all. A check that pushes brings the feel
  /// check with it.
  std::vector<std::string> only{};
};

/// What a check works with: the arm, opened anew for each of them.
struct HilRig {
  using Open = std::function<driver::Result<std::unique_ptr<bringup::BenchArm>>(TipHold hold)>;

  const scene::ArmFile& file;
  Open open;
  const std::atomic<bool>& stop;
  bringup::Prompt prompt;        ///< Asks a person to act; returns false to leave the check.
  bringup::Question question{};  ///< Asks a person yes or no; empty: the simulated hand is asked.
  bool attended = false;         ///< A person is there to do it, or a simulated hand.
};

/// Opens the simulated arm of a file as a check needs it: free, tied to a spring (N/m), or held by
/// a hand that does what a check asks. Real-time: never from the servo thread.
driver::Result<std::unique_ptr<bringup::BenchArm>> open_simulated(const scene::ArmFile& file,
                                                                  const HilOptions& options,
                                                                  TipHold hold);

/// Opens the arm for a check, activates it, and waits with zero force until the soft start is over.
driver::Result<std::unique_ptr<bringup::BenchArm>> open_active(const HilRig& rig, TipHold hold);

/// How a check ended.
enum class HilOutcome {
  kPassed,
  kFailed,
  kSkipped,  ///< It does not apply to this arm, or was not asked for.
  kNotRun,   ///< It should have run and did not: stopped, out of time, or not safe.
};

/// The words for an outcome.
struct HilOutcomeWords {
  HilOutcome outcome;
  const char* in_files;     ///< In JSON.
  const char* on_terminal;  ///< At most 7 characters.
};

/// All of them.
inline constexpr std::array<HilOutcomeWords, 4> kHilOutcomeWords{{
    {HilOutcome::kPassed, "passed", "ok"},
    {HilOutcome::kFailed, "failed", "FAILED"},
    {HilOutcome::kSkipped, "skipped", "skipped"},
    {HilOutcome::kNotRun, "not_run", "NOT RUN"},
}};

/// Returns those of one.
constexpr const HilOutcomeWords& words_of(HilOutcome outcome) {
  for (const HilOutcomeWords& words : kHilOutcomeWords) {
    if (words.outcome == outcome) return words;
  }
  return kHilOutcomeWords.back();
}

/// What one check found.
struct HilResult {
  std::string name;  ///< In lower_snake_case.
  HilOutcome outcome = HilOutcome::kSkipped;
  std::string text;  ///< One or more sentences.
  std::vector<session::Figure> figures;
  double seconds = 0;  ///< Wall time that it took.
  /// It was broken off: by a fault of the device, or by a motor that pulls the wrong way. Nothing
  /// may push after it.
  bool unsafe = false;
  bool fault = false;  ///< A fault of the device ended it.
};

/// Returns what of an arm a suite with these results did not test, a sentence each: what motion
/// alone cannot tell, and what can.
std::vector<std::string> not_tested(const scene::ArmFile& file, const HilOptions& options,
                                    const std::vector<HilResult>& results);

/// Returns a check that was not done, and why.
inline HilResult skipped(std::string name, std::string why) {
  return {std::move(name), HilOutcome::kSkipped, std::move(why), {}, 0, false, false};
}

/// Returns a check that should have run and did not, and why.
inline HilResult not_run(std::string name, std::string why) {
  return {std::move(name), HilOutcome::kNotRun, std::move(why), {}, 0, false, false};
}

/// Returns a check that ended before it found anything: its error, and the device's fault if that
/// was the reason.
HilResult broken_off(std::string name, const std::string& why, const bringup::BenchArm* bench);

/// Returns a check that passed if all its figures meet their goals.
HilResult judged(std::string name, std::string text, std::vector<session::Figure> figures);

}  // namespace thimble::hil
