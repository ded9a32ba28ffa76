#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/hand_signal.h"
#include "studies/accuracy/stiffest_wall.h"
#include "studies/accuracy/velocity_estimates.h"

namespace thimble::studies {
namespace {

constexpr double kTick = 1e-3;      // s
constexpr double kStep = 3e-5;      // m, encoder step at the tip [PHYSICS 0]
constexpr double kDamping = 1;      // N s/m, typical of scenes' surfaces
constexpr double kHand = 1;         // N s/m, a light grip
constexpr double kWallDamping = 2;  // N s/m [PHYSICS 1.1]
constexpr int kTicks = 8000;
constexpr int kSettle = 500;            // ticks before the evaluation
constexpr double kDefaultCorner = 100;  // Hz, app/arms/vintage_phantom.yaml

using Make = std::function<std::unique_ptr<VelocityEstimate>()>;

// Returns the error of the force of a damper of 1 N s/m, mN RMS.
double error_of(const Make& make) {
  const auto estimate = make();
  double squares = 0;
  for (int i = 0; i < kTicks; ++i) {
    const HandSignal hand = hand_signal(i * kTick);
    const double v = estimate->update(counted(hand.x, kStep));
    if (i >= kSettle) squares += (v - hand.v) * (v - hand.v);
  }
  return 1e3 * kDamping * std::sqrt(squares / (kTicks - kSettle));
}

// Returns the compliance of the stiffest wall with a damper of 2 N s/m and a hand, mm/N: the cost
// of the estimator's lag.
double compliance_of(const Make& make) {
  RestedWall wall;
  wall.viscous = kHand;
  wall.damping = kWallDamping;
  wall.estimate = make;
  return 1e3 / stiffest(wall);
}

Stroke work_of(const Make& make) {
  const std::shared_ptr<VelocityEstimate> estimate = make();
  std::vector<double> places;
  places.reserve(kTicks);
  for (int i = 0; i < kTicks; ++i) places.push_back(counted(hand_signal(i * kTick).x, kStep));
  return [estimate, places] {
    double sum = 0;
    for (const double x : places) sum += estimate->update(x);
    return sum;
  };
}

enum class Price { kForce, kLag };

AccuracyPoint point_of(const std::string& name, double knob, const Make& make, Price price) {
  return {.name = name,
          .knob = knob,
          .error = [=] { return price == Price::kForce ? error_of(make) : compliance_of(make); },
          .prepare = [make] { return work_of(make); },
          .ticks = kTicks,
          .law = {}};
}

std::vector<AccuracyLine> lines_of(Price price) {
  AccuracyLine pole{
      .name = "pole", .title = "difference, low-pass (product)", .order = {}, .points = {}};
  for (const double corner : {500.0, 200.0, 100.0, 50.0, 30.0, 15.0, 8.0}) {
    const double knob = 1e3 / (2 * M_PI * corner);
    pole.points.push_back(point_of(
        std::to_string(static_cast<int>(corner)) + "Hz", knob,
        [corner] { return product_estimate(corner, kTick); }, price));
    pole.points.back().is_default = corner == kDefaultCorner;
  }
  AccuracyLine window{
      .name = "window", .title = "difference over a window", .order = {}, .points = {}};
  AccuracyLine adaptive{.name = "adaptive", .title = "adaptive window", .order = {}, .points = {}};
  for (const int ticks : {1, 2, 4, 8, 16, 32, 64}) {
    window.points.push_back(point_of(
        std::to_string(ticks), ticks, [ticks] { return window_estimate(ticks, kTick); }, price));
    adaptive.points.push_back(point_of(
        std::to_string(ticks), ticks, [ticks] { return adaptive_estimate(ticks, kStep, kTick); },
        price));
  }
  AccuracyLine levant{
      .name = "levant", .title = "Levant's differentiator", .order = {}, .points = {}};
  for (const double max : {64.0, 16.0, 4.0, 2.0, 1.0, 0.5, 0.25}) {
    // Its response time is about the time in which that acceleration crosses a step.
    const double knob = 1e3 * std::sqrt(2 * kStep / max);
    levant.points.push_back(point_of(
        std::to_string(static_cast<int>(1000 * max)), knob,
        [max] { return levant_estimate(max, kTick); }, price));
  }
  std::vector<AccuracyLine> lines;
  for (AccuracyLine* line : {&pole, &window, &adaptive, &levant}) lines.push_back(std::move(*line));
  return lines;
}

AccuracyAxis axis_of(Price price) {
  AccuracyAxis axis;
  axis.knob = "time span of the estimate";
  axis.knob_unit = "ms";
  axis.lines = lines_of(price);
  return axis;
}

}  // namespace

AccuracyAxis velocity_axis() {
  AccuracyAxis axis = axis_of(Price::kForce);
  axis.name = "velocity";
  axis.title = "Estimates of velocity from an encoder of 30 um at 1 kHz";
  axis.metric = "force error of a damper of 1 N s/m, RMS";
  axis.unit = "mN";
  axis.truth = "The hand's velocity in closed form: strokes of 20 mm and 1 mm, and tremor.";
  axis.threshold = 20;  // [PHYSICS 6]
  axis.threshold_words = "the smallest noticeable force (20 mN)";
  axis.default_words =
      "The pole at 100 Hz adds little latency (13 % of the stiffness that damping "
      "permits). A longer time span is more accurate here, but less stable at a wall.";
  axis.left_out =
      "The effect of the lag at a wall: see the next diagram. The plain difference "
      "is the first point of the window.";
  return axis;
}

AccuracyAxis velocity_stiffness_axis() {
  AccuracyAxis axis = axis_of(Price::kLag);
  axis.name = "velocity_stiffness";
  axis.title =
      "Estimates of velocity: the stiffest wall with a damper that is stable in a "
      "hand";
  axis.metric = "compliance of the stiffest wall";
  axis.unit = "mm/N";
  axis.truth =
      "A wall in continuous time, which can have any stiffness: the latency is half "
      "a tick plus the lag of the estimate.";
  axis.threshold = kRigidCompliance;
  axis.threshold_words = kRigidWords;
  axis.default_words =
      "The plain difference lags less, but has more than twice the quantisation "
      "noise (see the previous diagram). The pole at 100 Hz costs a tenth of the "
      "stiffness.";
  axis.left_out =
      "Encoder steps, so that the diagram shows only the lag. The adaptive window "
      "and Levant's differentiator respond differently to counts.";
  return axis;
}

}  // namespace thimble::studies
