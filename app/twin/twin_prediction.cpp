#include "twin/twin_prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "stability/tuning.h"
#include "stability/wall_bench.h"
#include "stability/wall_trial.h"

namespace thimble::app {
namespace {

constexpr double kRate = 1000;  // Hz, at which arms are identified and recorded
constexpr int kPlaces = 8;      // of a wall within a step of the encoders [chosen]

/// Finds the stiffest wall at home to 1 %. Whether a stiff one rests hangs on where it stands
/// between two steps of the encoders, so that it must rest at each of some places.
driver::Result<double> stiffest_wall(const scene::ArmFile& arm, const ArmDirection& direction) {
  const Carried carried = carried_by(arm, loop_times(arm, kRate), 1000, 0);
  const double quiet = kQuietAtRest + kQuietSteps * carried.tip.encoder_step;
  int first = 0;  // the place at which the last one did not rest
  const auto rests = [&](double stiffness) -> driver::Result<bool> {
    for (int i = 0; i < kPlaces; ++i) {
      const int place = (first + i) % kPlaces;
      const double further = static_cast<double>(place) / kPlaces * direction.step;
      const auto touch = press_on_wall(arm, {.p_W = direction.p_WT + further * direction.n_W,
                                             .n_W = direction.n_W,
                                             .stiffness = stiffness,
                                             .rate = kRate});
      if (!touch) return touch.error();
      if (comes_to_rest(*touch, quiet)) continue;
      first = place;
      return false;
    }
    return true;
  };
  double low = carried.stiffness_exact / 10, high = carried.stiffness_exact * 10;
  while (high > 1.01 * low) {
    const double middle = std::sqrt(low * high);
    const auto quiet_there = rests(middle);
    if (!quiet_there) return quiet_there.error();
    (*quiet_there ? low : high) = middle;
  }
  return low;
}

}  // namespace

driver::Result<TwinPrediction> twin_prediction(const scene::ArmFile& file) {
  scene::ArmFile arm = file;
  // Tremor is drawn anew in each run, and no constant of the arm.
  arm.simulated.hand.tremor_amplitude = 0;
  const auto direction = worst_direction_at_home(arm);
  if (!direction) return direction.error();
  const auto edge = stiffest_wall(arm, *direction);
  if (!edge) return edge.error();
  TwinPrediction found;
  found.n_W = direction->n_W;
  found.stiffest_wall = *edge;
  found.drop.n_W = direction->n_W;
  const auto bounce = drop_on_wall(arm, found.drop);
  if (!bounce) return bounce.error();
  found.bounce = *bounce;
  return found;
}

std::vector<Figure> prediction_figures(const TwinPrediction& found) {
  const std::string wall =
      fmt::format("off a wall of {:g} N/m, by a pull of {:g} N over {:g} mm", found.drop.stiffness,
                  found.drop.pull, 1e3 * found.drop.height);
  return {{"predicted_stiffest_wall", found.stiffest_wall, "N/m", "",
           "on which the hand of the arm file comes to rest"},
          {"predicted_restitution", found.bounce.restitution, "", "", wall},
          {"predicted_flight", found.bounce.flight, "s", "", wall}};
}

std::string prediction_text(const TwinPrediction& found) {
  return fmt::format(
      "Along ({:.2g}, {:.2g}, {:.2g}) at home the hand of the file comes to rest on walls of up to "
      "{:.0f} N/m.\n"
      "A free tip that {:g} N draw {:g} mm onto a wall of {:g} N/m leaves it with {:.2f} times its "
      "speed and is back after {:.0f} ms.\n",
      found.n_W.x(), found.n_W.y(), found.n_W.z(), found.stiffest_wall, found.drop.pull,
      1e3 * found.drop.height, found.drop.stiffness, found.bounce.restitution,
      1e3 * found.bounce.flight);
}

}  // namespace thimble::app
