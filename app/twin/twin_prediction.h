#pragma once

#include <string>
#include <vector>

#include "report/figure_output.h"
#include "stability/drop_trial.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::twin {

/// Predictions of a twin for its arm: a wall and a bounce.
struct TwinPrediction {
  Eigen::Vector3d n_W{0, 0, 1};  ///< Axis of both, the worst one at home.
  /// Stiffest wall on which the hand of the arm's file comes to rest from half of its starts, N/m:
  /// the first such wall, raised from below. A start is the position of the wall between two
  /// encoder steps, the speed of the hand (0.15 to 0.25 m/s), and the stiffness of the wall within
  /// 7.5 %. On a stiff wall each of these determines whether it comes to rest, for an arm and for
  /// its twin.
  double stiffest_wall = 0;
  stability::DropTrial drop;  ///< Wall onto which the tip is dropped.
  stability::Bounce bounce;   ///< Without the hand.
};

/// Runs both with the simulated arm of a file, through the whole loop at 1 kHz. Fails if the arm
/// has no board of its own to simulate, or if the tip does not bounce. Real-time: never from the
/// servo thread.
driver::Result<TwinPrediction> twin_prediction(const scene::ArmFile& file);

/// Returns a prediction as figures: the stiffest wall, restitution and time of flight.
std::vector<session::Figure> prediction_figures(const TwinPrediction& prediction);

/// Returns a prediction as two sentences.
std::string prediction_text(const TwinPrediction& prediction);

}  // namespace thimble::twin
