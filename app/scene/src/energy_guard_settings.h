#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "loop_latency.h"
#include "thimble/driver/energy_guard.h"
#include "thimble/driver/export.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

/// How a file names the stages, in the order of the enum.
inline const std::vector<std::string_view> kEnergyStageNames{"none", "passivity", "bounding"};

/// The energy that may go out before the controller acts, J: the most that hard case 11 allows a
/// guarded wall [PHYSICS 7]. A hand of 0.1 kg is not moved faster than 0.2 m/s by it.
inline constexpr double kEnergyAllowance = 0.002;

/// The debt at which the controller damps as hard as it may, J [chosen: as much again; so it
/// sets in softly, and what runs away is stopped for sure].
inline constexpr double kEnergyOnset = 0.002;

/// Damping that a hand which holds the arm has for sure, N s/m [chosen: a third of what a pinch
/// grip has, PHYSICS 0 and 1]. What a sampled field gives beyond its potential is paid for by it.
inline constexpr double kSureHandDamping = 1;

/// Returns the energy stage's settings for a loop of `rate` (Hz): what the arm file, and a scene in
/// place of it, say, joined with what follows from the arm: the mass at the tip, the delay, for the
/// reservoir what a spring of the declared stiffness holds at the declared force, for the slope the
/// arm's own friction over the latency, b / L [PHYSICS 1.1]. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT driver::EnergyGuardSettings energy_settings(
    const ArmFile& arm, double rate, std::optional<driver::EnergyStage> scene);

/// Returns the delay from encoder to motors beyond the hold, s, as far as the arm's file tells;
/// otherwise a frame for the report and one for the force, 1 ms [PHYSICS 5].
THIMBLE_EXPORT double loop_delay(const ArmFile& arm);

/// Returns the times of a loop of `rate` (Hz) with the reports that this arm sends. The force
/// changes with the first tick after each report, so `period` is the larger of both periods in the
/// mean, `period_spread` what remains where neither divides the other, and `delay` what a report
/// waits for its tick, on top of `loop_delay`. The first tick comes with the first report, as a run
/// begins. The jitter of the wire is not in it. Real-time: never from the servo thread.
THIMBLE_EXPORT LoopTimes loop_pace(const ArmFile& arm, double rate);

}  // namespace thimble::scene
