#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "study/accuracy/axes.h"
#include "study/accuracy/hand_signal.h"
#include "study/accuracy/velocity_estimates.h"

namespace thimble::app {
namespace {

constexpr double kTick = 1e-3;  // s
constexpr double kStep = 3e-5;  // m, an encoder's at the tip [STABILITY, heading]
constexpr double kDamping = 1;  // N s/m, what most scenes' surfaces have
constexpr int kTicks = 8000;
constexpr int kSettle = 500;            // ticks that are not counted
constexpr double kDefaultCorner = 100;  // Hz, app/arms/vintage_phantom.yaml

using Make = std::function<std::unique_ptr<VelocityEstimate>()>;

// The error of the force of a damper of 1 N s/m, mN RMS.
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

Stroke work_of(const Make& make) {
  const std::shared_ptr<VelocityEstimate> estimate = make();
  std::vector<double> places;
  for (int i = 0; i < kTicks; ++i) places.push_back(counted(hand_signal(i * kTick).x, kStep));
  return [estimate, places] {
    double sum = 0;
    for (const double x : places) sum += estimate->update(x);
    return sum;
  };
}

AccuracyPoint point_of(const std::string& name, double knob, const Make& make) {
  return {.name = name,
          .knob = knob,
          .error = [make] { return error_of(make); },
          .prepare = [make] { return work_of(make); },
          .ticks = kTicks,
          .law = {}};
}

}  // namespace

AccuracyAxis velocity_axis() {
  AccuracyAxis axis;
  axis.name = "velocity";
  axis.title = "Estimates of velocity from an encoder of 30 um at 1 kHz";
  axis.knob = "how far back the estimate looks";
  axis.knob_unit = "ms";
  axis.metric = "force error of a damper of 1 N s/m, RMS";
  axis.unit = "mN";
  axis.truth = "The hand's velocity in closed form: strokes of 20 mm and 1 mm, and tremor.";
  axis.threshold = 20;  // [STABILITY 6]
  axis.threshold_words = "the smallest force that is felt (20 mN)";
  axis.default_words =
      "The pole at 100 Hz costs little latency, which stability pays for (13 % of the stiffness "
      "that "
      "damping buys); a longer look is truer here and shakier at a wall.";
  axis.left_out =
      "What the lag costs at a wall, which the latency diagram shows. The difference alone is the "
      "first point of the window.";
  AccuracyLine pole{
      .name = "pole", .title = "difference, low-pass (product)", .order = {}, .points = {}};
  for (const double corner : {500.0, 200.0, 100.0, 50.0, 30.0, 15.0, 8.0}) {
    const double knob = 1e3 / (2 * M_PI * corner);
    pole.points.push_back(point_of(std::to_string(static_cast<int>(corner)) + "Hz", knob,
                                   [corner] { return product_estimate(corner, kTick); }));
    pole.points.back().is_default = corner == kDefaultCorner;
  }
  AccuracyLine window{
      .name = "window", .title = "difference over a window", .order = {}, .points = {}};
  AccuracyLine adaptive{.name = "adaptive", .title = "adaptive window", .order = {}, .points = {}};
  for (const int ticks : {1, 2, 4, 8, 16, 32, 64}) {
    window.points.push_back(
        point_of(std::to_string(ticks), ticks, [ticks] { return window_estimate(ticks, kTick); }));
    adaptive.points.push_back(point_of(std::to_string(ticks), ticks,
                                       [ticks] { return adaptive_estimate(ticks, kStep, kTick); }));
  }
  AccuracyLine levant{
      .name = "levant", .title = "Levant's differentiator", .order = {}, .points = {}};
  for (const double most : {64.0, 16.0, 4.0, 2.0, 1.0, 0.5, 0.25}) {
    // It answers within about the time in which that acceleration crosses a step.
    const double knob = 1e3 * std::sqrt(2 * kStep / most);
    levant.points.push_back(point_of(std::to_string(static_cast<int>(1000 * most)), knob,
                                     [most] { return levant_estimate(most, kTick); }));
  }
  axis.lines = {std::move(pole), std::move(window), std::move(adaptive), std::move(levant)};
  return axis;
}

}  // namespace thimble::app
