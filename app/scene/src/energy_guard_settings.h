#pragma once

#include <optional>
#include <string_view>
#include <vector>

#include "loop_latency.h"
#include "thimble/driver/energy_guard.h"
#include "thimble/driver/export.h"
#include "thimble/scene/arm_file.h"

namespace thimble::scene {

/// Names of the stages in files, in the order of the enum.
inline const std::vector<std::string_view> kEnergyStageNames{"none", "passivity", "bounding"};

/// Energy that may be given before the controller acts, J: the largest that hard case 11 allows a
/// guarded wall [PHYSICS 7]. It moves a hand of 0.1 kg at no more than 0.2 m/s.
inline constexpr double kEnergyAllowance = 0.002;

/// Debt at which the controller applies its maximum damping, J [chosen: as much again; so damping
/// starts softly, and a runaway is stopped reliably].
inline constexpr double kEnergyOnset = 0.002;

/// Guaranteed damping of a hand that holds the arm, N s/m [chosen: a third of what a pinch grip
/// has, PHYSICS 0 and 1]. It pays for the energy that a sampled field gives beyond its potential.
inline constexpr double kSureHandDamping = 1;

/// Returns the settings of the energy stage for a loop of `rate` (Hz), from the arm file, or the
/// scene instead. Missing values follow from the arm: mass at the tip and delay. The reservoir is
/// the energy of a spring with the declared stiffness at the declared force. The slope is the arm's
/// own friction over the latency, b / L [PHYSICS 1.1]. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::EnergyGuardSettings energy_settings(
    const ArmFile& arm, double rate, std::optional<driver::EnergyStage> scene);

/// Returns the delay from encoder to motors in addition to the hold, s, if the arm's file defines
/// it; otherwise a frame for the report and one for the force, 1 ms [PHYSICS 5].
THIMBLE_EXPORT double loop_delay(const ArmFile& arm);

/// Returns the times of a loop of `rate` (Hz) with the report rate of this arm. The force changes
/// with the first tick after each report. Therefore `period` is the larger of both periods on
/// average, `period_spread` is its remaining variation if neither divides the other, and `delay`
/// adds the time a report waits for its tick to `loop_delay`. The first tick coincides with the
/// first report, as at the start of a run. The jitter of the wire is not included. Real-time: never
/// from the servo thread.
THIMBLE_EXPORT LoopTimes loop_pace(const ArmFile& arm, double rate);

}  // namespace thimble::scene
