#pragma once

#include <optional>
#include <string>
#include <vector>

#include "report/figure_output.h"
#include "stability/stability_laws.h"
#include "thimble/driver/result.h"
#include "thimble/scene/scene_file.h"
#include "worst_direction.h"

namespace thimble::stability {

/// What an arm, its loop and its hand can carry by the laws, in the worst direction.
struct Carried {
  scene::LoopTimes times;
  double latency = 0;          ///< s
  scene::TipLimits tip;        ///< Of the arm alone.
  double damping = 0;          ///< Of arm and hand, N s/m.
  double stiffness_law = 0;    ///< (b + B) / L, N/m.
  double stiffness_exact = 0;  ///< Of the exact linear map with hand and velocity filter, N/m.
  /// The same for the worst of all hands of a third to three times mass, stiffness and damping of
  /// the file's, for these are guesses [PHYSICS 9], N/m; and that hand.
  double stiffness_any_hand = 0;
  device_sim::HandSettings worst_hand;
  /// What is safe to ask for, N/m: part of the one, and part of the other, at whose edge an
  /// oscillation takes for ever to die.
  double stiffness_safe = 0;
  double passive = 0;     ///< For any hand: min(2 b / T with delay, 2 c / d), N/m.
  double held_speed = 0;  ///< Fastest oscillation that dry friction holds without a hand, m/s, at
                          ///< the stiffness asked for.
  double bristle_stiffness = 0;  ///< Stiffest bristle that stays quiet, F / z_max, N/m.
};

/// Finds it for a loop of `times`, a wall of `stiffness` (N/m) and `damping` (N s/m).
Carried carried_by(const scene::ArmFile& arm, const scene::LoopTimes& times, double stiffness,
                   double damping);

/// Returns the times of a loop of `rate` (Hz) with this arm, without jitter.
scene::LoopTimes loop_times(const scene::ArmFile& arm, double rate, double period_spread = 0);

/// Returns a sentence for each object of a scene that asks for more than arm, loop and hand can
/// carry: what it asks, what can be had, and what to change; nothing for a scene that is in order.
std::vector<std::string> stability_warnings(const scene::Scene& scene);

/// What `thimble tune` tells.
struct TuneResult {
  std::vector<session::Figure> figures;
  std::string text;  ///< For a person.
};

/// How old the positions are that forces answer where another program computes them, s.
struct AnswerAges {
  double median = 0;
  double most = 0;  ///< that 99 % do not exceed
};

/// How thorough a tuning is.
struct TuneOptions {
  double period_spread = 0;  ///< Standard deviation of the loop's period, s.
  int places_per_side = 2;   ///< Walls are tried at so many places per side of the workspace.
  /// Measured over the topics of ROS 2; empty: nothing is said of them.
  std::optional<AnswerAges> topics = {};
};

/// Returns what a scene asks and what can be had: by the laws, and simulated through the whole loop
/// in three directions at places all over the workspace. Fails if the scene cannot be opened: a
/// mesh that cannot be read, or a hand that the arm cannot follow. Real-time: never from the servo
/// thread.
driver::Result<TuneResult> tune(const scene::Scene& scene, const TuneOptions& options);

}  // namespace thimble::stability
