#include <cmath>
#include <memory>
#include <string>

#include "stability/stability_laws.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/impact.h"
#include "studies/accuracy/stiffest_wall.h"
#include "studies/accuracy/stroked_ring.h"
#include "studies/cost/cost_subjects.h"

namespace thimble::studies {
namespace {

constexpr double kStrokeMs = 1000;

// Prepares a second of touch on the ring at this rate, for the cost of more ticks.
Stroke work_at(double rate) {
  const std::shared_ptr<render::ObjectTouch> touch = build_ring({});
  const auto ticks = static_cast<int>(rate);
  return [touch, states = ring_stroke(kCostRing, ticks, 1 / rate)] {
    double sum = 0;
    for (const auto& state : states) sum += touch->update(state).f_T_W.x();
    return sum;
  };
}

AccuracyAxis axis_of_rates() {
  AccuracyAxis axis;
  axis.knob = "time of a tick";
  axis.knob_unit = "ms";
  axis.per = "ms of touch";
  return axis;
}

constexpr double kRates_kHz[] = {0.25, 0.5, 1, 2, 4, 8, 16, 32};

struct Line {
  const char* name;
  const char* title;
  double stiffness;
  double delay_ticks;
};

}  // namespace

AccuracyAxis loop_rate_axis() {
  AccuracyAxis axis = axis_of_rates();
  axis.name = "loop_rate";
  axis.title = "Loop rate: speed that a free arm gains from a wall";
  axis.metric = "speed gained by a bounce, e - 1";
  axis.unit = std::string("%");
  axis.truth =
      "A wall in continuous time, which returns the speed of the impact: e = 1 "
      "(apart from the arm's own friction, which the law includes).";
  axis.threshold = 3.5;
  axis.threshold_words = "half the noticeable change of impact (3.5 %)";
  axis.default_words =
      "1 kHz is the rate of full-speed USB, and the rate that textbooks require. A "
      "free arm bounces at this rate. In a hand, the hand's 3 N s/m dissipate more "
      "than the wall generates. The key rate: of the scene sets faster loops for "
      "arms that support them.";
  axis.left_out =
      "The hand and dry friction, which damp these oscillations and only help. "
      "Textures, which gain from rates up to 5 to 10 kHz.";
  const Line lines[] = {{"soft", "800 N/m", 800, 0},
                        {"stiff", "3000 N/m", 3000, 0},
                        {"delayed", "800 N/m, one tick of delay", 800, 1}};
  for (const Line& one : lines) {
    AccuracyLine line{.name = one.name, .title = one.title, .order = 1, .points = {}};
    for (const double khz : kRates_kHz) {
      const Impact impact{.viscous = 1e-4,
                          .stiffness = one.stiffness,
                          .period = 1e-3 / khz,
                          .delay = 1e-3 / khz * one.delay_ticks};
      const double latency = scene::latency_of({.period = impact.period, .delay = impact.delay});
      AccuracyPoint point{.name = std::to_string(static_cast<int>(1000 * khz)) + "Hz",
                          .knob = 1 / khz,
                          .error = [=] { return 100 * (mean_restitution(impact) - 1); },
                          .prepare = [=] { return work_at(1000 * khz); }};
      point.ticks = kStrokeMs;
      point.is_default = khz == 1 && one.delay_ticks == 0 && one.stiffness == 800;
      point.fits = khz >= 4;
      point.law =
          100 *
          (stability::restitution(impact.stiffness, impact.viscous, impact.mass, latency) - 1);
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

AccuracyAxis loop_rate_stiffness_axis() {
  AccuracyAxis axis = axis_of_rates();
  axis.name = "loop_rate_stiffness";
  axis.title = "Loop rate: the stiffest wall that is stable in a hand";
  axis.metric = "compliance of the stiffest wall";
  axis.unit = "mm/N";
  axis.truth =
      "A wall in continuous time, which can have any stiffness. Also drawn: the law "
      "K = (b / L) u / sin u, u tan u = b L / m, where L is half a tick plus the "
      "delay.";
  axis.threshold = kRigidCompliance;
  axis.threshold_words = kRigidWords;
  axis.default_words =
      "1 kHz is the rate of full-speed USB, and the rate that textbooks require. It "
      "renders 6 N/mm in a hand, which feels hard (more than 0.8 N/mm) but not rigid.";
  axis.left_out = "Arms that are more compliant than the wall; encoder steps.";
  const Line lines[] = {{"hand", "in a hand of 3 N s/m", 0, 0},
                        {"light", "in a light hand of 1 N s/m", 0, 0},
                        {"delayed", "in a hand, one tick of delay", 0, 1}};
  for (const Line& one : lines) {
    AccuracyLine line{.name = one.name, .title = one.title, .order = 1, .points = {}};
    for (const double khz : kRates_kHz) {
      RestedWall wall;
      if (line.name == "light") wall.viscous = 1;
      wall.period = 1e-3 / khz;
      wall.delay = one.delay_ticks * wall.period;
      AccuracyPoint point{.name = std::to_string(static_cast<int>(1000 * khz)) + "Hz",
                          .knob = 1 / khz,
                          .error = [=] { return 1e3 / stiffest(wall); },
                          .prepare = [=] { return work_at(1000 * khz); }};
      point.ticks = kStrokeMs;
      point.is_default = khz == 1 && line.name == "hand";
      point.fits = khz >= 2 && khz <= 16;
      const double latency = scene::latency_of({.period = wall.period, .delay = wall.delay});
      point.law = 1e3 / stability::late_stiffness_limit(wall.viscous, latency, wall.mass);
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

}  // namespace thimble::studies
