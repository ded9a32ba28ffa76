#pragma once

#include <string>
#include <vector>

#include "report/figure_output.h"
#include "stability/drop_trial.h"
#include "thimble/driver/result.h"
#include "thimble/scene/arm_file.h"

namespace thimble::twin {

/// What a twin says of its arm before anybody tries it: a wall and a bounce.
struct TwinPrediction {
  Eigen::Vector3d n_W{0, 0, 1};  ///< The axis that both are along, the worst one at home.
  /// On which the hand of the arm's file comes to rest from half of its starts, N/m: the first that
  /// does, raised from below. A start is where between two steps of the encoders the wall stands,
  /// how fast the hand meets it (0.15 to 0.25 m/s), and how stiff the wall is within 7.5 %: of a
  /// stiff wall each decides whether it rests, of one arm as of its twin.
  double stiffest_wall = 0;
  stability::DropTrial drop;  ///< The wall that the tip is dropped on.
  stability::Bounce bounce;   ///< Free of the hand.
};

/// Tries both with the simulated arm of a file, through the whole loop at 1 kHz. Fails if the arm
/// has no board of its own to simulate, or nothing bounces. Real-time: never from the servo thread.
driver::Result<TwinPrediction> twin_prediction(const scene::ArmFile& file);

/// Returns a prediction as figures: the stiffest wall, restitution and time of flight.
std::vector<session::Figure> prediction_figures(const TwinPrediction& prediction);

/// Returns a prediction as two sentences.
std::string prediction_text(const TwinPrediction& prediction);

}  // namespace thimble::twin
