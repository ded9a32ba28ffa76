#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/friction_work.h"
#include "studies/accuracy/hand_signal.h"
#include "studies/accuracy/velocity_estimates.h"
#include "studies/friction/friction_cases.h"

namespace thimble::studies {
namespace {

constexpr double kTick = 1e-3;      // s
constexpr double kStiffness = 800;  // N/m
constexpr double kDamping = 1;      // N s/m
constexpr int kTicks = 4000;
constexpr double kSteps[] = {1, 3, 10, 30, 100};  // um
constexpr double kDefaultStep = 30;               // um [PHYSICS 0]

struct Wall {
  double damping = 0;
  double corner = 0;  // Hz
};

// Returns the error of the wall's force by quantised positions, mN RMS.
double error_of(const Wall& wall, double step) {
  const auto counted_speed = product_estimate(wall.corner, kTick);
  const auto smooth_speed = product_estimate(wall.corner, kTick);
  double squares = 0;
  for (int i = 0; i < kTicks; ++i) {
    const double x = hand_signal(i * kTick).x;
    const double seen = counted(x, step);
    const double off = kStiffness * (seen - x) +
                       wall.damping * (counted_speed->update(seen) - smooth_speed->update(x));
    squares += off * off;
  }
  return 1e3 * std::sqrt(squares / kTicks);
}

Stroke work_of(const Wall& wall, double step) {
  const std::shared_ptr<VelocityEstimate> speed = product_estimate(wall.corner, kTick);
  std::vector<double> places;
  places.reserve(kTicks);
  for (int i = 0; i < kTicks; ++i) places.push_back(counted(hand_signal(i * kTick).x, step));
  return [speed, places, wall] {
    double sum = 0;
    for (const double x : places) sum += kStiffness * x + wall.damping * speed->update(x);
    return sum;
  };
}

}  // namespace

AccuracyAxis encoder_axis() {
  AccuracyAxis axis;
  axis.name = "encoder";
  axis.title = "Encoder resolution: noise in the force of a wall of 800 N/m";
  axis.knob = "encoder step at the tip";
  axis.knob_unit = "um";
  axis.metric = "force error, RMS";
  axis.unit = "mN";
  axis.truth =
      "The same wall with exact positions; for the spring without damper the closed "
      "form K step / sqrt(12), drawn as a thin line.";
  axis.threshold = 20;
  axis.threshold_words = "the smallest noticeable force (20 mN)";
  axis.over_cost = false;
  axis.given = true;
  axis.default_words = "the encoders determine the step.";
  axis.left_out =
      "The error over the cost: a tick costs the same with any step. The stiffness "
      "limit by dry friction, 2 c / step, and the amplitude of limit cycles: see "
      "`thimble study stability`. A step of zero, which cannot be drawn on this "
      "scale and has no error.";
  struct Line {
    const char* name;
    const char* title;
    Wall wall;
  };
  const Line lines[] = {{"spring", "spring alone", {}},
                        {"difference", "damper of 1 N s/m, difference", {kDamping, 0}},
                        {"pole", "damper, low-pass at 100 Hz (product)", {kDamping, 100}}};
  for (const Line& one : lines) {
    AccuracyLine line{.name = one.name, .title = one.title, .order = 1, .points = {}};
    for (const double um : kSteps) {
      const Wall wall = one.wall;
      AccuracyPoint point{.name = std::to_string(static_cast<int>(um)) + "um",
                          .knob = um,
                          .error = [=] { return error_of(wall, 1e-6 * um); },
                          .prepare = [=] { return work_of(wall, 1e-6 * um); }};
      point.ticks = kTicks;
      point.is_default = um == kDefaultStep && wall.corner > 0;
      point.fits = true;
      if (wall.damping == 0) point.law = 1e3 * kStiffness * 1e-6 * um / std::sqrt(12.0);
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

AccuracyAxis encoder_friction_axis() {
  AccuracyAxis axis;
  axis.name = "encoder_friction";
  axis.title = "Encoder resolution: limit cycles of friction under a creeping hand";
  axis.knob = "encoder step at the tip";
  axis.knob_unit = "um";
  axis.metric = "force above 50 Hz at 1 mm/s, RMS";
  axis.unit = "mN";
  axis.truth = "Coulomb friction slides evenly: no force above 50 Hz.";
  axis.threshold = 20;
  axis.threshold_words = "the smallest noticeable force (20 mN)";
  axis.over_cost = false;
  axis.given = true;
  axis.default_words = "the encoders determine the step.";
  axis.left_out = "The error over the cost: a tick costs the same with any step.";
  for (const FrictionCase& which : friction_cases()) {
    if (which.name != "naive_hold" && which.name != "paper_velocity" && which.name != "bristle") {
      continue;
    }
    AccuracyLine line{.name = which.name, .title = which.title, .order = {}, .points = {}};
    for (const double um : kSteps) {
      stability::FrictionRigSettings rig;
      rig.encoder_step = 1e-6 * um;
      line.points.push_back(
          {.name = std::to_string(static_cast<int>(um)) + "um",
           .knob = um,
           .error = [&which, rig] { return 1e3 * creep_of(which, rig).limit_cycle; },
           .prepare = [&which, rig] { return friction_work(which, rig); },
           .ticks = kFrictionTicks,
           .is_default = um == kDefaultStep && which.name == "bristle",
           .law = {}});
    }
    axis.lines.push_back(std::move(line));
  }
  return axis;
}

}  // namespace thimble::studies
