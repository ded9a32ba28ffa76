#include <cmath>
#include <string>

#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/friction_work.h"
#include "studies/friction/friction_cases.h"

namespace thimble::studies {
namespace {

constexpr double kForce = 0.5;  // N, Coulomb friction
// Deflection of a stuck bristle before it slides, mm.
constexpr double kLengths[] = {0.05, 0.1, 0.2, 0.4, 0.8, 1.6};

enum class Wrong { kLimitCycle, kTooLight };

// In mN.
double error_of(const FrictionCase& which, Wrong wrong) {
  const Creep creep = creep_of(which, {});
  return 1e3 * (wrong == Wrong::kLimitCycle ? creep.limit_cycle : std::abs(kForce - creep.mean));
}

AccuracyPoint point_of(const FrictionCase& which, const std::string& name, double knob,
                       Wrong wrong) {
  return {.name = name,
          .knob = knob,
          .error = [which, wrong] { return error_of(which, wrong); },
          .prepare = [which] { return friction_work(which, {}); },
          .ticks = kFrictionTicks,
          .law = {}};
}

AccuracyAxis axis_of(Wrong wrong) {
  AccuracyAxis axis;
  axis.knob = "bristle: deflection before it slides";
  axis.knob_unit = "mm";
  axis.unit = "mN";
  axis.truth = "Set-valued Coulomb friction, which is exactly 0.5 N at a constant creep.";
  axis.threshold = 20;
  axis.threshold_words = "the smallest noticeable force (20 mN)";
  AccuracyLine bristles{
      .name = "bristle", .title = "bristle, by its length", .order = {}, .points = {}};
  AccuracyLine others{
      .name = "models", .title = "each model as shipped", .order = {}, .apart = true, .points = {}};
  for (const FrictionCase& which : friction_cases()) {
    if (which.stiffness > 0) continue;
    others.points.push_back(point_of(which, which.name, NAN, wrong));
    others.points.back().title =
        which.title + (which.letter.empty() ? "" : " (" + which.letter + ")");
    others.points.back().is_default = which.name == "bristle";
    if (which.name != "bristle") continue;
    for (const double length : kLengths) {
      FrictionCase other = which;
      other.stiffness = kForce / (1e-3 * length);
      bristles.points.push_back(
          point_of(other, std::to_string(static_cast<int>(1000 * length)) + "um", length, wrong));
    }
  }
  axis.lines = {std::move(bristles), std::move(others)};
  axis.default_words =
      "Cheaper models have larger limit cycles, or creep under any load. The "
      "exception is the stiction point: its limit cycle is not noticeable here "
      "either, and it costs a twentieth less. The bristle has a quarter of that "
      "limit cycle, and none at rest with any delay (see `thimble study friction`).";
  return axis;
}

}  // namespace

AccuracyAxis friction_axis() {
  AccuracyAxis axis = axis_of(Wrong::kLimitCycle);
  axis.name = "friction";
  axis.title = "Models of friction under a hand that creeps at 1 mm/s: limit cycles";
  axis.metric = "force above 50 Hz, RMS";
  axis.left_out =
      "Rest after a stop, drift and delays: see `thimble study friction`. The "
      "letters are those of its table. C, the sign of a smoothed velocity, is not in "
      "the product, because it has the limit cycle of B and lags.";
  return axis;
}

AccuracyAxis friction_stiction_axis() {
  AccuracyAxis axis = axis_of(Wrong::kTooLight);
  axis.name = "friction_stiction";
  axis.title = "Models of friction under a hand that creeps at 1 mm/s: mean force";
  axis.metric = "mean force missing of 0.5 N";
  axis.left_out =
      "The bristle's error has no slope: it counts what the hand has not yet slid when the second "
      "begins.";
  return axis;
}

}  // namespace thimble::studies
