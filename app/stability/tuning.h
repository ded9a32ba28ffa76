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

/// Limits of an arm, its loop and its hand by the laws, in the worst direction.
struct StabilityLimits {
  scene::LoopTimes times;
  double latency = 0;          ///< s
  scene::TipLimits tip;        ///< Limits of the arm without a hand.
  double damping = 0;          ///< Damping of arm and hand, N s/m.
  double stiffness_law = 0;    ///< (b + B) / L, N/m.
  double stiffness_exact = 0;  ///< By the exact linear map with hand and velocity filter, N/m.
  /// The same for the worst of all hands with a third to three times mass, stiffness and damping of
  /// the file's, which are guesses [PHYSICS 9], N/m; and that hand.
  double stiffness_any_hand = 0;
  device_sim::HandSettings worst_hand;
  /// Safe stiffness, N/m: the smaller of a share of `stiffness_exact` and a share of
  /// `stiffness_any_hand`. At the limits themselves an oscillation never decays.
  double stiffness_safe = 0;
  double passive = 0;     ///< For any hand: min(2 b / T with delay, 2 c / d), N/m.
  double held_speed = 0;  ///< Fastest oscillation that dry friction stops without a hand, m/s, at
                          ///< the requested stiffness.
  double bristle_stiffness = 0;  ///< Stiffest bristle that stays quiet, F / z_max, N/m.
};

/// Computes the limits for a loop of `times`, a wall of `stiffness` (N/m) and `damping` (N s/m).
StabilityLimits stability_limits(const scene::ArmFile& arm, const scene::LoopTimes& times,
                                 double stiffness, double damping);

/// Returns the times of a loop of `rate` (Hz) with this arm, without jitter.
scene::LoopTimes loop_times(const scene::ArmFile& arm, double rate, double period_spread = 0);

/// Returns a sentence for each object of a scene that exceeds the limits of arm, loop and hand: the
/// requested value, the possible one, and the remedy. Empty if no object does.
std::vector<std::string> stability_warnings(const scene::Scene& scene);

/// Result of `thimble tune`.
struct TuneResult {
  std::vector<session::Figure> figures;
  std::string text;  ///< Report for the user.
};

/// Age of the positions to which forces respond if another program computes them, s.
struct AnswerAges {
  double median = 0;
  double percentile_99 = 0;  ///< 99th percentile
};

/// Options of a tuning.
struct TuneOptions {
  double period_spread = 0;  ///< Standard deviation of the loop's period, s.
  int places_per_side = 2;   ///< Walls are tried at this many points per side of the workspace.
  /// Measured over the topics of ROS 2; empty: not reported.
  std::optional<AnswerAges> topics = {};
};

/// Returns the requested and the possible values of a scene: by the laws, and simulated through the
/// whole loop in three directions at points throughout the workspace. Fails if the scene cannot be
/// opened: a mesh that cannot be read, or a hand that the arm cannot follow. Real-time: never from
/// the servo thread.
driver::Result<TuneResult> tune(const scene::Scene& scene, const TuneOptions& options);

}  // namespace thimble::stability
