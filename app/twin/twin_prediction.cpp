#include "twin/twin_prediction.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "stability/raised_edge.h"
#include "stability/tuning.h"
#include "stability/wall_bench.h"
#include "stability/wall_trial.h"

namespace thimble::twin {
namespace {

constexpr double kRate = 1000;  // Hz, rate of identification and recording
constexpr int kTriesMax = 64;   // max. number of tries of a stiffness [chosen]: half of them is
                                // known to a sixteenth, which is one deviation
constexpr int kClear = 8;       // majority after which no further one is tried
constexpr double kSpeed = 0.2, kSpeedSpan = 0.1;  // m/s, mean speed of the hand and range of starts

/// Tries walls at home, each from many starts.
class WallStarts {
 public:
  WallStarts(const scene::ArmFile& arm, const stability::ArmDirection& direction)
      : arm_(arm),
        direction_(direction),
        carried_(stability::stability_limits(arm, stability::loop_times(arm, kRate), 1000, 0)),
        quiet_(stability::kQuietAtRest + stability::kQuietSteps * carried_.tip.encoder_step) {}

  /// Returns the stiffness by the law, N/m.
  double by_law() const { return carried_.stiffness_exact; }

  /// Returns whether the hand comes to rest from more than half of the starts, on walls of about
  /// this stiffness (N/m).
  driver::Result<bool> mostly_rest(double stiffness) const {
    int more = 0;  // number of starts that rest minus those that do not
    for (int i = 0; i < kTriesMax && std::abs(more) < kClear; ++i) {
      const auto touch = from(i, stiffness);
      if (!touch) return touch.error();
      more += stability::comes_to_rest(*touch, quiet_) ? 1 : -1;
    }
    return more > 0;
  }

 private:
  /// Any number of starts is spread evenly, by multiples of the golden section and of the roots of
  /// 2 and 3. They vary the position of the wall within an encoder step, the speed of the hand, and
  /// the stiffness of the wall, within one step of raising it.
  driver::Result<stability::WallTouch> from(int start, double stiffness) const {
    const auto spread = [start](double by) {
      const double at = by * (start + 0.5);
      return at - std::floor(at);
    };
    const double further = spread(std::numbers::phi - 1) * direction_.step;
    return stability::press_on_wall(
        arm_, {.p_W = direction_.p_WT + further * direction_.n_W,
               .n_W = direction_.n_W,
               .stiffness = stiffness * (1 + (stability::kWallRaised - 1) *
                                                 (spread(std::numbers::sqrt3) - 0.5)),
               .rate = kRate,
               .speed = kSpeed + kSpeedSpan * (spread(std::numbers::sqrt2) - 0.5)});
  }

  const scene::ArmFile& arm_;
  const stability::ArmDirection& direction_;
  stability::StabilityLimits carried_;
  double quiet_;  // m
};

/// Returns the stiffest wall at home to 1 %. Whether a stiff one rests depends on its position
/// between two encoder steps and on the approach, so the result is the median over these. Some
/// stiffer walls rest from half of the starts again, and some softer ones hardly from half, so
/// walls of similar stiffness are included.
driver::Result<double> stiffest_wall(const scene::ArmFile& arm,
                                     const stability::ArmDirection& direction) {
  const WallStarts starts(arm, direction);
  return stability::raised_edge(
      starts.by_law() / 10, 10 * starts.by_law(),
      [&starts](double stiffness) { return starts.mostly_rest(stiffness); });
}

}  // namespace

driver::Result<TwinPrediction> twin_prediction(const scene::ArmFile& file) {
  scene::ArmFile arm = file;
  // Tremor is random in each run, and not a constant of the arm.
  arm.simulated.hand.tremor_amplitude = 0;
  const auto direction = stability::worst_direction_at_home(arm);
  if (!direction) return direction.error();
  const auto edge = stiffest_wall(arm, *direction);
  if (!edge) return edge.error();
  TwinPrediction found;
  found.n_W = direction->n_W;
  found.stiffest_wall = *edge;
  found.drop.n_W = direction->n_W;
  const auto bounce = stability::drop_on_wall(arm, found.drop);
  if (!bounce) return bounce.error();
  found.bounce = *bounce;
  return found;
}

std::vector<session::Figure> prediction_figures(const TwinPrediction& found) {
  const std::string wall =
      fmt::format("from a wall of {:g} N/m, with a pull of {:g} N over {:g} mm",
                  found.drop.stiffness, found.drop.pull, 1e3 * found.drop.height);
  return {{"predicted_stiffest_wall", found.stiffest_wall, "N/m", "",
           "wall on which the hand of the arm file comes to rest from half of its starts"},
          {"predicted_restitution", found.bounce.restitution, "", "", wall},
          {"predicted_flight", found.bounce.flight, "s", "", wall}};
}

std::string prediction_text(const TwinPrediction& found) {
  return fmt::format(
      "Prediction along ({:.2g}, {:.2g}, {:.2g}) at home: the hand of the file comes to rest on a "
      "wall of {:.0f} N/m from half of its starts, and on softer walls from more.\nA free tip, "
      "pulled by {:g} N over {:g} mm onto a wall of {:g} N/m, leaves the wall with {:.2f} times "
      "its speed and returns after {:.0f} ms.\n",
      found.n_W.x(), found.n_W.y(), found.n_W.z(), found.stiffest_wall, found.drop.pull,
      1e3 * found.drop.height, found.drop.stiffness, found.bounce.restitution,
      1e3 * found.bounce.flight);
}

}  // namespace thimble::twin
