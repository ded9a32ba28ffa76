#include <cmath>
#include <memory>
#include <string>

#include "stability_laws.h"
#include "study/accuracy/axes.h"
#include "study/accuracy/impact.h"
#include "study/accuracy/stroked_ring.h"
#include "study/cost_subjects.h"

namespace thimble::app {
namespace {

constexpr double kStrokeMs = 1000;

// A second of touch on the ring at this rate: what more ticks cost.
Stroke work_at(double rate) {
  const std::shared_ptr<render::ObjectTouch> touch = build_ring({});
  const auto ticks = static_cast<int>(rate);
  return [touch, states = ring_stroke(kCostRing, ticks, 1 / rate)] {
    double sum = 0;
    for (const auto& state : states) sum += touch->update(state).f_T_W.x();
    return sum;
  };
}

struct Line {
  const char* name;
  const char* title;
  double stiffness;
  double delay_ticks;
};

}  // namespace

AccuracyAxis loop_rate_axis() {
  AccuracyAxis axis;
  axis.name = "loop_rate";
  axis.title = "What the rate of the loop buys: speed that a wall gives a free arm";
  axis.knob = "time of a tick";
  axis.knob_unit = "ms";
  axis.metric = "speed gained by a bounce, e - 1";
  axis.unit = std::string("%");
  axis.truth =
      "A wall in continuous time, which returns the speed it was given: e = 1 (but for the "
      "arm's own friction, which the law counts in).";
  axis.threshold = 3.5;
  axis.threshold_words = "half the impact that can just be told apart (3.5 %)";
  axis.per = "ms of touch";
  axis.default_words =
      "1 kHz is what full-speed USB carries and what textbooks ask for. A free arm bounces there; "
      "in a "
      "hand the hand's 3 N s/m take more than the wall gives. Faster loops are a line in the scene "
      "(rate:) where the arm can follow.";
  axis.left_out =
      "The hand, which damps what is seen here, and dry friction, which stops the smallest swings: "
      "both only help. Textures, which gain up to 5 to 10 kHz.";
  const Line lines[] = {{"soft", "800 N/m", 800, 0},
                        {"stiff", "3000 N/m", 3000, 0},
                        {"delayed", "800 N/m, one tick of delay", 800, 1}};
  for (const Line& one : lines) {
    AccuracyLine line{.name = one.name, .title = one.title, .order = 1, .points = {}};
    for (const double khz : {0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0, 32.0}) {
      const Impact impact{.viscous = 1e-4,
                          .stiffness = one.stiffness,
                          .period = 1e-3 / khz,
                          .delay = 1e-3 / khz * one.delay_ticks};
      const double latency = latency_of({.period = impact.period, .delay = impact.delay});
      AccuracyPoint point{.name = std::to_string(static_cast<int>(1000 * khz)) + "Hz",
                          .knob = 1 / khz,
                          .error = [=] { return 100 * (mean_restitution(impact) - 1); },
                          .prepare = [=] { return work_at(1000 * khz); }};
      point.ticks = kStrokeMs;
      point.is_default = khz == 1 && one.delay_ticks == 0 && one.stiffness == 800;
      point.fits = khz >= 4;
      point.law = 100 * (restitution(impact.stiffness, impact.viscous, impact.mass, latency) - 1);
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

}  // namespace thimble::app
