#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "energy_guard_settings.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/guarded_wall.h"
#include "studies/accuracy/hand_signal.h"
#include "studies/accuracy/held_motion.h"

namespace thimble::studies {
namespace {

using driver::EnergyStage;

constexpr double kTick = GuardedArm::kTick;
constexpr double kSpeed = 0.2;  // m/s, impact speed
constexpr double kStep = 3e-5;  // m, encoder step [PHYSICS 0]
constexpr double kPull = 1;     // N, towards the wall [PHYSICS 1.6]
constexpr int kBounces = 20;
constexpr int kBouncingTicks = 40000;
constexpr int kPhases = 40;
constexpr int kWorkTicks = 4000;
constexpr double kStiffnesses[] = {250, 500, 1000, 2000, 4000};  // N/m
constexpr double kUsual = 1000;                                  // N/m

// Returns the gain of speed in the 20th bounce of an arm that a hand pulls back to the wall, in
// percent. It is 0 if speed is lost, or if the arm stays on the wall. A budget of energy allows the
// first bounces, so the 20th shows the long-term behaviour.
double gained(const WallGuard& guard, double stiffness) {
  double sum = 0;
  for (int phase = 0; phase < kPhases; ++phase) {
    GuardedWall wall(guard, stiffness);
    // Depth and its rate; the first two ticks are free.
    LineMotion now{-kSpeed * kTick * (1 + (phase + 0.5) / kPhases), kSpeed};
    double in = kSpeed;
    double last = 1;  // speed out divided by speed in, of the last bounce
    int bounces = 0;
    for (int i = 0; i < kBouncingTicks && bounces < kBounces; ++i) {
      const LineMotion before = now;
      now = moved_by_held_force(now, GuardedArm::kMass, GuardedArm::kViscous,
                                kPull - wall.force(now.x), kTick);
      if (!(std::abs(now.x) < 1e3)) return NAN;
      // Uses energy, because the pull between the tick and the surface does not belong to the wall.
      const double at_surface =
          std::sqrt(std::max(now.v * now.v - 2 * kPull / GuardedArm::kMass * now.x, 0.0));
      if (before.x <= 0 && now.x > 0) in = at_surface;
      if (before.x > 0 && now.x <= 0) {
        last = in > 0 ? at_surface / in : 1;
        ++bounces;
      }
    }
    sum += bounces < kBounces ? 1 : last;
  }
  return std::max(100 * (sum / kPhases - 1), 0.0);
}

// Returns the loss of stiffness when a hand presses 1 mm deep within 0.2 s and waits, in percent.
double softened(const WallGuard& guard, double stiffness) {
  GuardedWall wall(guard, stiffness);
  constexpr double kDepth = 0.001;
  double force = 0;
  for (int i = 0; i < 400; ++i) force = wall.force(kDepth * std::min(i / 200.0, 1.0));
  return 100 * std::max(1 - force / (stiffness * kDepth), 0.0);
}

// Returns the error of force by the encoder's steps while a hand presses in and out, mN RMS.
double encoder_noise(const WallGuard& guard, double stiffness) {
  GuardedWall stepped(guard, stiffness);
  GuardedWall smooth(guard, stiffness);
  constexpr double kShare = 0.1;  // of the hand's amplitude: 2 mm
  double squares = 0;
  for (int i = 0; i < kWorkTicks; ++i) {
    const double depth = kShare * hand_signal(i * kTick).x;
    const double off = stepped.force(counted(depth, kStep)) - smooth.force(depth);
    squares += off * off;
  }
  return 1e3 * std::sqrt(squares / kWorkTicks);
}

Stroke work_of(const WallGuard& guard, double stiffness) {
  const auto wall = std::make_shared<GuardedWall>(guard, stiffness);
  return [wall] {
    double sum = 0;
    for (int i = 0; i < kWorkTicks; ++i) sum += wall->force(0.001 * std::sin(0.01 * i));
    return sum;
  };
}

struct Line {
  const char* name;
  const char* title;
  WallGuard guard;
};
constexpr Line kLines[] = {
    {"none", "limits only", {}},
    {"passivity",
     "observer and controller (product)",
     {.stage = EnergyStage::kPassivity,
      .allowance = scene::kEnergyAllowance,
      .onset = scene::kEnergyOnset}},
    {"at_once", "controller that acts immediately", {.stage = EnergyStage::kPassivity}},
    {"bounding", "energy bound", {.stage = EnergyStage::kBounding}},
    {"coupling",
     "virtual coupling for the free arm (not in the product)",
     {.counted_on = GuardedArm::kViscous}},
    {"held_coupling",
     "virtual coupling for the arm in a hand (not in the product)",
     {.counted_on = GuardedArm::kViscous + GuardedArm::kHand}}};

AccuracyAxis axis_of(double (*error)(const WallGuard&, double)) {
  AccuracyAxis axis;
  axis.knob = "stiffness of the wall";
  axis.knob_unit = "N/m";
  axis.unit = std::string("%");
  axis.over_cost = false;
  for (const Line& one : kLines) {
    AccuracyLine line{.name = one.name, .title = one.title};
    const WallGuard guard = one.guard;
    for (const double stiffness : kStiffnesses) {
      AccuracyPoint point{.name = std::to_string(static_cast<int>(stiffness)),
                          .knob = stiffness,
                          .error = [=] { return error(guard, stiffness); },
                          .prepare = [=] { return work_of(guard, stiffness); }};
      point.ticks = kWorkTicks;
      point.is_default = line.name == "passivity" && stiffness == kUsual;
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  axis.default_words =
      "The shipped controller lets out 2 mJ before it acts, so the first bounces "
      "gain as much as without it. It ends a bounce that grows without limit, and "
      "cannot be felt otherwise. A controller that acts immediately would also stop "
      "the first bounce, but would jolt by half a newton at encoder steps. The "
      "energy bound generates no energy at any stiffness, but feels like a wall of a "
      "hundredth of the stiffness. The same holds for a virtual coupling designed "
      "for the free arm. A coupling designed for a hand generates energy without the "
      "hand, and softens stiff walls.";
  return axis;
}

}  // namespace

AccuracyAxis safety_axis() {
  AccuracyAxis axis = axis_of(gained);
  axis.name = "safety";
  axis.title =
      "Energy stages of the safety gate: speed gained from a wall at 1 kHz in the "
      "20th bounce";
  axis.metric = "speed gained in the 20th bounce";
  axis.truth = "A passive wall, which adds no speed: e <= 1.";
  axis.threshold = 3.5;
  axis.threshold_words = "half the noticeable change of impact (3.5 %)";
  axis.left_out =
      "The error over the cost, which depends only on the stage and not on the "
      "stiffness (see the figures). The first bounces, which an energy allowance "
      "permits. Loops with delay, which tests of the whole loop cover.";
  return axis;
}

AccuracyAxis safety_stiffness_axis() {
  AccuracyAxis axis = axis_of(softened);
  axis.name = "safety_stiffness";
  axis.title = "Energy stages of the safety gate: stiffness lost under a resting hand";
  axis.metric = "stiffness lost";
  axis.truth = "The wall's own stiffness, pressed 1 mm deep.";
  axis.threshold = 8;  // [PHYSICS 6]
  axis.threshold_words = "half the noticeable change of stiffness (8 %)";
  axis.left_out = "The time until a press gives its full force; walls of moving objects.";
  return axis;
}

AccuracyAxis safety_noise_axis() {
  AccuracyAxis axis = axis_of(encoder_noise);
  axis.name = "safety_noise";
  axis.title = "Energy stages of the safety gate: force error due to encoder steps of 30 um";
  axis.metric = "force error, RMS";
  axis.unit = "mN";
  axis.truth = "The same stage and wall with exact positions, stroked by the same hand.";
  axis.threshold = 20;
  axis.threshold_words = "the smallest noticeable force (20 mN)";
  axis.left_out =
      "The closed loop through hand and arm, in which this noise moves the arm. An "
      "encoder without steps, which adds no error with any stage.";
  return axis;
}

}  // namespace thimble::studies
