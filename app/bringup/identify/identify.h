#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "bringup/bench_arm.h"
#include "bringup/identify/arm_constants.h"
#include "bringup/identify/cables.h"
#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"

namespace thimble::app {

/// The most that identifying asks an arm for, N.
inline constexpr double kIdentifyForceMax = 1.0;

/// How an arm is identified.
struct IdentifyOptions {
  double seconds = 60;  ///< Of each motion; 10 at the least.
  double lead = 1;      ///< That it moves before each, s.
  /// Whether cables that stretch are looked for; if not, an arm that has some is a bad fit.
  bool cables = true;
  double known_mass = 0;   ///< That the user fixes to the tip for the second motion, kg; 0: none.
  std::uint64_t seed = 1;  ///< Of the excitation's phases.
  /// Handed each tick of the motion with the bare tip, for a recording; may be empty.
  std::function<void(const driver::TickRecord&)> watch{};
};

/// What was found, and what speaks against it.
struct Identified {
  ArmConstants constants;
  PerMass bare;                   ///< The fit of the motion without the known mass.
  std::optional<PerMass> loaded;  ///< Of that with it, if there was one.
  CableFit lines;                 ///< What the lines of the motion without it say of its cables.
  /// Why the model of a rigid arm does not fit, a sentence each; empty: it does. Nothing may be
  /// written then.
  std::vector<std::string> against;
};

/// Returns why fits do not mean what they say, a sentence each: a hand or a spring at the tip, a
/// motion that mass, friction and weight do not explain, frames that are missing. `held` is the
/// first motion with a spring to be found in it.
std::vector<std::string> speaks_against(const PerMass& fit, const PerMass& held, double mass);

/// Opens the bench for one motion: with the known mass on the tip, or without it.
using OpenBench = std::function<driver::Result<std::unique_ptr<BenchArm>>(bool loaded)>;

/// Moves a free arm, with and without a known mass, and finds its constants. No force beyond what
/// the bench was opened with (kIdentifyForceMax), all of it through the gate. The error says why
/// there is nothing to tell. Real-time: never from the servo thread.
driver::Result<Identified> identify(const OpenBench& open, const scene::ArmFile& file,
                                    const IdentifyOptions& options, const std::atomic<bool>& stop);

/// Returns what was seen of cables that stretch, or from which frequency on none would have been.
std::string cables_text(const Identified& identified);

/// Returns a table of the constants with their intervals, and what they rest on.
std::string constants_table(const Identified& identified);

}  // namespace thimble::app
