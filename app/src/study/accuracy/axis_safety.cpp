#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "study/accuracy/axes.h"
#include "thimble/driver/energy_guard.h"
#include "thimble/driver/safety_gate.h"

namespace thimble::app {
namespace {

using driver::EnergyStage;
using Eigen::Vector3d;

constexpr double kMass = 0.075;     // kg [STABILITY, heading]
constexpr double kViscous = 0.005;  // N s/m
constexpr double kTick = 1e-3;      // s
constexpr double kSpeed = 0.2;      // m/s, of the impact
constexpr int kPhases = 40;
constexpr int kWorkTicks = 4000;
constexpr double kStiffnesses[] = {250, 500, 1000, 2000, 4000};  // N/m
constexpr double kUsual = 1000;                                  // N/m

driver::EnergyGuardSettings settings_of(EnergyStage stage) {
  driver::EnergyGuardSettings settings;
  settings.stage = stage;
  settings.mass = kMass;
  settings.allowance = 0;
  settings.reservoir = 0.01;              // J
  settings.onset = 0;                     // the plain controller of [STABILITY 1.6]
  settings.slope = 2 * kViscous / kTick;  // passive [STABILITY 1.6]
  return settings;
}

driver::SafetyGate gate_of(EnergyStage stage) {
  const driver::GateLimits limits{.force_max = 100,
                                  .speed_max = 100,
                                  .rise_max = 1e9,
                                  .soft_start = 1e-9,
                                  .stall_ns = 1'000'000'000,
                                  .watchdog_ns = 2'000'000'000};
  return driver::SafetyGate(limits, settings_of(stage));
}

/// Is a wall behind a gate: what the gate lets through, tick by tick along z.
class GuardedWall {
 public:
  GuardedWall(EnergyStage stage, double stiffness)
      : gate_(gate_of(stage)), guarded_(stage != EnergyStage::kNone), stiffness_(stiffness) {
    gate_.restart();
  }
  /// Takes the depth (m) at this tick and tells the force against it, N.
  double force(double depth) noexcept {
    const Vector3d move(0, 0, begun_ ? last_depth_ - depth : 0);
    const Vector3d wanted(0, 0, depth > 0 ? stiffness_ * depth : 0);
    const double dt = begun_ ? kTick : 0;
    const Vector3d sent =
        guarded_ ? gate_
                       .pass_guarded(wanted, move / kTick, dt,
                                     {.work = sent_.dot(move), .move_W = move, .f_sent_W = sent_})
                       .f_T_W()
                 : gate_.pass(wanted, move / kTick, dt).f_T_W();
    last_depth_ = depth;
    sent_ = sent;
    begun_ = true;
    return sent.z();
  }

 private:
  driver::SafetyGate gate_;
  bool guarded_;
  double stiffness_;
  double last_depth_ = 0;
  Vector3d sent_{0, 0, 0};
  bool begun_ = false;
};

// The speed that a free mass gains in a bounce, in percent; 0 if it loses some.
double gained(EnergyStage stage, double stiffness) {
  double sum = 0;
  for (int phase = 0; phase < kPhases; ++phase) {
    GuardedWall wall(stage, stiffness);
    double x = -kSpeed * kTick * (1 + (phase + 0.5) / kPhases);  // depth; two free ticks first
    double v = kSpeed;
    for (int i = 0; i < 20000 && !(x < 0 && v < 0); ++i) {
      const double end = -wall.force(x) / kViscous;
      const double fade = -std::expm1(-kViscous / kMass * kTick);
      x += end * kTick + (v - end) * fade * kMass / kViscous;
      v += (end - v) * fade;
      if (!(std::abs(x) < 1)) return NAN;
    }
    sum += -v / kSpeed;
  }
  return std::max(100 * (sum / kPhases - 1), 0.0);
}

// The stiffness that is missing when a hand presses 1 mm deep within 0.2 s and waits, in percent.
double softened(EnergyStage stage, double stiffness) {
  GuardedWall wall(stage, stiffness);
  constexpr double kDepth = 0.001;
  double force = 0;
  for (int i = 0; i < 400; ++i) force = wall.force(kDepth * std::min(i / 200.0, 1.0));
  return 100 * std::max(1 - force / (stiffness * kDepth), 0.0);
}

Stroke work_of(EnergyStage stage, double stiffness) {
  const auto wall = std::make_shared<GuardedWall>(stage, stiffness);
  return [wall] {
    double sum = 0;
    for (int i = 0; i < kWorkTicks; ++i) sum += wall->force(0.001 * std::sin(0.01 * i));
    return sum;
  };
}

struct Stage {
  EnergyStage stage;
  const char* name;
  const char* title;
};
constexpr Stage kStages[] = {{EnergyStage::kNone, "none", "limits alone"},
                             {EnergyStage::kPassivity, "passivity", "observer and controller"},
                             {EnergyStage::kBounding, "bounding", "energy bound"}};

AccuracyAxis axis_of(double (*error)(EnergyStage, double)) {
  AccuracyAxis axis;
  axis.knob = "stiffness of the wall";
  axis.knob_unit = "N/m";
  axis.unit = std::string("%");
  axis.over_cost = false;
  for (const Stage& one : kStages) {
    AccuracyLine line{.name = one.name, .title = one.title};
    const EnergyStage stage = one.stage;
    for (const double stiffness : kStiffnesses) {
      AccuracyPoint point{.name = std::to_string(static_cast<int>(stiffness)),
                          .knob = stiffness,
                          .error = [=] { return error(stage, stiffness); },
                          .prepare = [=] { return work_of(stage, stiffness); }};
      point.ticks = kWorkTicks;
      point.is_default = stage == EnergyStage::kPassivity && stiffness == kUsual;
      line.points.push_back(std::move(point));
    }
    axis.lines.push_back(std::move(line));
  }
  axis.default_words =
      "Without a stage a stiff wall throws the arm back faster than it came; the bound stops that "
      "too, but is felt as a wall of a hundredth of the stiffness. The controller is the one that "
      "does little while nothing is wrong, which the two diagrams show only together.";
  return axis;
}

}  // namespace

AccuracyAxis safety_axis() {
  AccuracyAxis axis = axis_of(gained);
  axis.name = "safety";
  axis.title = "Energy stages of the safety gate: speed that a wall gives a free arm at 1 kHz";
  axis.metric = "speed gained by a bounce";
  axis.truth = "A passive wall, which gives none: e <= 1.";
  axis.threshold = 3.5;
  axis.threshold_words = "half the impact that can just be told apart (3.5 %)";
  axis.left_out =
      "The error over the cost: it is the stage's alone, whatever the stiffness (see the figures). "
      "The ramp with which the product's controller sets in, and the energy it lets pass first: "
      "here "
      "it acts at once. The virtual coupling, which the product does not have.";
  return axis;
}

AccuracyAxis safety_stiffness_axis() {
  AccuracyAxis axis = axis_of(softened);
  axis.name = "safety_stiffness";
  axis.title = "Energy stages of the safety gate: stiffness that is missing under a resting hand";
  axis.metric = "stiffness missing";
  axis.truth = "The wall's own stiffness, pressed 1 mm deep.";
  axis.threshold = 8;  // [STABILITY 6]
  axis.threshold_words = "the stiffness that cannot be told apart (8 %)";
  axis.left_out = "The force quanta of the controller on an encoder with steps.";
  return axis;
}

}  // namespace thimble::app
