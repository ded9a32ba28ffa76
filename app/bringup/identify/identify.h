#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "bringup/bench_arm.h"
#include "bringup/identify/arm_constants.h"
#include "bringup/identify/cables/backlash/find_play.h"
#include "bringup/identify/cables/cables.h"
#include "bringup/identify/cogging/motor_waves.h"
#include "bringup/identify/encoders.h"
#include "bringup/identify/friction_directions.h"
#include "bringup/identify/link_inertia/look_over_places.h"
#include "bringup/identify/rubbing_joints.h"
#include "bringup/identify/saturation.h"
#include "bringup/identify/weak_form/fitted_motion.h"
#include "bringup/loop_priority.h"
#include "bringup/report_timing.h"
#include "bringup/watchdog_time.h"
#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"

namespace thimble::bringup {

/// The most that identifying asks an arm for unless the user says another, N.
inline constexpr double kIdentifyForceMax = 1.0;

/// How an arm is identified.
struct IdentifyOptions {
  double seconds = 60;  ///< Of each motion; 10 at the least.
  double lead = 1;      ///< That it moves before each, s.
  /// Whether cables that stretch are looked for; if not, an arm that has some is a bad fit.
  bool cables = true;
  /// Whether play and friction of joints are looked for: beside cables that stretch those of the
  /// motors, else friction alone. If not, an arm that has some is a bad fit.
  bool play = true;
  double known_mass = 0;  ///< That the user fixes to the tip for the second motion, kg; 0: none.
  double force_most = kIdentifyForceMax;  ///< The most that is asked for, N; the file's at most.
  /// Whether the reports' timing and the firmware's watchdog are measured after the motion; the
  /// watchdog by pushes of a little more than the friction that was found.
  bool link = false;
  /// To how many places of its workspace an arm is led after the motion with its bare tip, so that
  /// the inertia of its links shows: three at least, nine at most; 0: none. They add to the time.
  int places = 0;
  double place_seconds = 5;  ///< Of the motion about each of them.
  std::uint64_t seed = 1;    ///< Of the excitation's phases.
  /// Handed each tick of the motion with the bare tip, for a recording; may be empty.
  std::function<void(const driver::TickRecord&)> watch{};
};

/// What was found, and what speaks against it.
struct Identified {
  ArmConstants constants;
  PerMass bare;                   ///< The fit of the motion without the known mass.
  std::optional<PerMass> loaded;  ///< Of that with it, if there was one.
  CableFit lines;                 ///< What the lines of the motion without it say of its cables.
  LineSpectrum spectrum;          ///< These lines.
  /// Play of cables that stretch and friction of their motors. Where some is seen, `lines` and
  /// `bare` are this fit's.
  PlayFit play;
  /// Cogging and ripple of the motors, which all motions here are freed of.
  MotorWaves waves;
  /// Friction of the joints of a rigid arm, which all motions here are freed of as well.
  RubbingJoints rubbing;
  /// The motion without the known mass, of the links where cables stretch: what `bare` fits.
  ArmMotion moved;
  double moved_ahead = 0;  ///< Of the delay, what that motion was freed from already, s.
  /// What motion over the workspace says of links. Where it saw some, `moved` knows them, so that
  /// `bare` fits the tip beside them, and `constants` are those of this fit.
  OverPlaces over;
  FrictionDirections friction;
  Encoders encoders;  ///< At rest only if the reports' timing was asked for.
  /// Joint by joint; nothing is searched for behind cables that stretch.
  std::array<Saturation, 3> saturation;
  LateTicks late;                        ///< Of the loop in all motions.
  std::optional<ReportTiming> reports;   ///< If they were asked for.
  std::optional<WatchdogTime> watchdog;  ///< If it was asked for, and the fit is good.
  /// Why the model of a rigid arm does not fit, a sentence each; empty: it does. Nothing may be
  /// written then.
  std::vector<std::string> against;

  /// Returns the mass that the constants of `bare` are per.
  Estimate moved_mass() const {
    return constants.links ? over.fit->constant(LinkFit::kMass) : constants.mass;
  }

  /// Returns the dry friction of a joint of a rigid arm, N m, and the viscous, N m s/rad.
  Estimate joint_coulomb(std::size_t joint) const {
    return by_gain(rubbing.coulomb[joint], constants.gain[joint]);
  }
  Estimate joint_viscous(std::size_t joint) const {
    return by_gain(rubbing.viscous[joint], constants.gain[joint]);
  }

  /// Returns the motion with what its fit leaves. It must not outlive this.
  FittedMotion fitted() const {
    PerMass fit = bare;
    fit.delay.value -= moved_ahead;
    return {moved, fit};
  }
};

/// Returns whether a spring to a place holds the tip, found in a fit with one.
bool is_held(const PerMass& held, double mass);

/// Returns why fits do not mean what they say, a sentence each: a hand or a spring at the tip, a
/// motion that mass, friction and weight do not explain, frames that are missing. `held` is the
/// same motion with a spring to be found in it; `stretches`: it is that of links behind cables.
std::vector<std::string> speaks_against(const PerMass& fit, const PerMass& held, double mass,
                                        bool stretches = false);

/// Returns the sentence about a motion in which many ticks came late. It stands instead of other
/// reasons: a force that stood for longer looks like cables, play or a hand.
std::string late_ticks_text(const LateTicks& late);

/// Opens the bench for one motion: with the known mass on the tip, or without it.
using OpenBench = std::function<driver::Result<std::unique_ptr<BenchArm>>(bool loaded)>;

/// Returns why a largest force and a known mass do not go together, or not with the file's limits.
driver::Result<void> check_forces(const scene::ArmFile& file, const IdentifyOptions& options);

/// Moves a free arm, with and without a known mass, and finds its constants. No force beyond
/// `force_most`, which the bench was opened with too, all of it through the gate. The error says
/// why there is nothing to tell. Real-time: never from the servo thread.
driver::Result<Identified> identify(const OpenBench& open, const scene::ArmFile& file,
                                    const IdentifyOptions& options, const std::atomic<bool>& stop);

}  // namespace thimble::bringup
