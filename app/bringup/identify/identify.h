#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "bringup/bench_arm.h"
#include "bringup/identify/arm_constants.h"
#include "bringup/identify/cables/backlash/find_backlash.h"
#include "bringup/identify/cables/cables.h"
#include "bringup/identify/cogging/motor_cogging.h"
#include "bringup/identify/encoders.h"
#include "bringup/identify/friction_directions.h"
#include "bringup/identify/joint_friction_fit.h"
#include "bringup/identify/link_inertia/sweep_workspace.h"
#include "bringup/identify/saturation.h"
#include "bringup/identify/weak_form/fitted_motion.h"
#include "bringup/loop_priority.h"
#include "bringup/report_timing.h"
#include "bringup/watchdog_time.h"
#include "thimble/driver/result.h"
#include "thimble/driver/tick_record.h"

namespace thimble::bringup {

/// Default max. force of an identification, N.
inline constexpr double kIdentifyForceMax = 1.0;

/// Options of an identification.
struct IdentifyOptions {
  double seconds = 60;  ///< Duration of each motion, s; at least 10.
  double lead = 1;      ///< Motion before each recording, s.
  /// Whether elastic cables are searched for; if not, an arm that has some gives a bad fit.
  bool cables = true;
  /// Whether backlash and friction of joints are searched for: with elastic cables those of the
  /// motors, else friction only. If not, an arm that has some gives a bad fit.
  bool play = true;
  double known_mass = 0;  ///< Mass fixed to the tip for the second motion, kg; 0: none.
  double max_force = kIdentifyForceMax;  ///< Max. requested force, N; at most the file's.
  /// Whether the reports' timing and the firmware's watchdog are measured after the motion; the
  /// watchdog by pushes slightly above the friction that was found.
  bool link = false;
  /// Number of poses of the workspace to which the arm is led after the motion with its bare tip:
  /// three to nine; 0: none. They show the inertia of its links. They add to the time.
  int places = 0;
  double place_seconds = 5;  ///< Duration of the motion about each of these poses, s.
  std::uint64_t seed = 1;    ///< Seed of the excitation's phases.
  /// Called with each tick of the motion with the bare tip, for a recording; may be empty.
  std::function<void(const driver::TickRecord&)> watch{};
};

/// Result of an identification, and reasons to distrust it.
struct Identified {
  ArmConstants constants;
  MassNormalisedFit bare;  ///< Fit of the motion without the known mass.
  std::optional<MassNormalisedFit>
      loaded;             ///< Fit of the motion with the known mass, if there was one.
  CableFit lines;         ///< Result of the lines of the motion without it about cables.
  LineSpectrum spectrum;  ///< The lines themselves.
  /// Backlash of elastic cables and friction of their motors. If some is seen, `lines` and `bare`
  /// come from this fit.
  BacklashResult play;
  /// Cogging and ripple of the motors, removed from all motions here.
  MotorCogging waves;
  /// Friction of the joints of a rigid arm, also removed from all motions here.
  JointFrictionFit rubbing;
  /// The motion without the known mass, which `bare` fits; with elastic cables, that of the links.
  ArmMotion moved;
  double moved_ahead = 0;  ///< Part of the delay already removed from that motion, s.
  /// Links found from motion over the workspace. If some are seen, `moved` contains them, so that
  /// `bare` fits the tip without links, and `constants` come from this fit.
  WorkspaceSweep over;
  FrictionDirections friction;
  Encoders encoders;  ///< At rest only if the reports' timing was requested.
  /// Joint by joint; not searched for behind elastic cables.
  std::array<Saturation, 3> saturation;
  LateTicks late;                        ///< Loop timing in all motions.
  std::optional<ReportTiming> reports;   ///< If requested.
  std::optional<WatchdogTime> watchdog;  ///< If requested, and the fit is good.
  /// Reasons why the model of a rigid arm does not fit, a sentence each; empty: it fits. Otherwise
  /// nothing may be written.
  std::vector<std::string> against;

  /// Returns the mass to which the constants of `bare` are relative.
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

  /// Returns the motion with the residual of its fit. It must not outlive this object.
  FittedMotion fitted() const {
    MassNormalisedFit fit = bare;
    fit.delay.value -= moved_ahead;
    return {moved, fit};
  }
};

/// Returns whether a spring to a point holds the tip, according to a fit with one.
bool is_held(const MassNormalisedFit& held, double mass);

/// Returns reasons to distrust fits, a sentence each: a hand or a spring at the tip, a motion that
/// mass, friction and weight do not explain, missing frames. `held` is the fit of the same motion
/// with a spring; `stretches`: the motion is that of links behind cables.
std::vector<std::string> fit_warnings(const MassNormalisedFit& fit, const MassNormalisedFit& held,
                                      double mass, bool stretches = false);

/// Returns the sentence about a motion in which many ticks were late. It replaces other reasons: a
/// force that was held for longer looks like cables, backlash or a hand.
std::string late_ticks_text(const LateTicks& late);

/// Opens the bench for one motion, with or without the known mass on the tip.
using OpenBench = std::function<driver::Result<std::unique_ptr<BenchArm>>(bool loaded)>;

/// Returns the max. force of an identification that names none: 1 N, or the limit of the arm file
/// if that is lower, N.
double default_max_force(const scene::ArmFile& file);

/// Returns an error if poses are requested from an arm with less than three motors.
driver::Result<void> check_places(const scene::ArmFile& file, const IdentifyOptions& options);

/// Returns an error if the max. force and the known mass are incompatible with each other or with
/// the file's limits.
driver::Result<void> check_forces(const scene::ArmFile& file, const IdentifyOptions& options);

/// Moves a free arm, with and without a known mass, and finds its constants. No force exceeds
/// `max_force`, with which the bench was also opened; all forces pass the gate. The error explains
/// why there is no result. Real-time: never from the servo thread.
driver::Result<Identified> identify(const OpenBench& open, const scene::ArmFile& file,
                                    const IdentifyOptions& options, const std::atomic<bool>& stop);

}  // namespace thimble::bringup
