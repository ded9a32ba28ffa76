#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "plant/axis_dynamics.h"
#include "studies/accuracy/axes/axes.h"
#include "studies/accuracy/pushed_arm.h"

namespace thimble::studies {
namespace {

using Arm = PushedArm;

enum class Method { kEuler, kMidpoint, kRungeKutta };

/// Integrates the same motion with textbook methods.
class Stepped {
 public:
  Stepped(Method method, int substeps, bool dry)
      : method_(method), h_(Arm::kTick / substeps), substeps_(substeps), dry_(dry) {}

  LineMotion tick(double force) noexcept {
    for (int i = 0; i < substeps_; ++i) step(force);
    return now_;
  }

 private:
  // Dry friction for methods with several evaluations per step: smoothed at 1 mm/s.
  double pull(const LineMotion& at, double force) const noexcept {
    double f = force - Arm::kViscous * at.v;
    if (dry_) return (f - Arm::kCoulomb * std::tanh(at.v / 1e-3)) / Arm::kMass;
    f -= Arm::kHandStiffness * at.x + Arm::kHandDamping * at.v;
    return f / Arm::kMass;
  }
  // Dry friction that stops at zero speed.
  double rubbed(double v, double time) const noexcept {
    if (!dry_) return v;
    const double max = Arm::kCoulomb / Arm::kMass * time;
    return v > max ? v - max : v < -max ? v + max : 0;
  }
  double smooth_pull(const LineMotion& at, double force) const noexcept {
    double f = force - Arm::kViscous * at.v;
    if (!dry_) f -= Arm::kHandStiffness * at.x + Arm::kHandDamping * at.v;
    return f / Arm::kMass;
  }
  static LineMotion moved(const LineMotion& at, double v, double a, double time) noexcept {
    return {at.x + time * v, at.v + time * a};
  }

  void step(double force) noexcept {
    switch (method_) {
      case Method::kEuler: {
        now_.v = rubbed(now_.v + h_ * smooth_pull(now_, force), h_);
        now_.x += h_ * now_.v;
        return;
      }
      case Method::kMidpoint: {
        const LineMotion half{now_.x + h_ / 2 * now_.v,
                              rubbed(now_.v + h_ / 2 * smooth_pull(now_, force), h_ / 2)};
        const double a = smooth_pull(half, force);
        now_.x += h_ * half.v;
        now_.v = rubbed(now_.v + h_ * a, h_);
        return;
      }
      case Method::kRungeKutta: {
        const double a1 = pull(now_, force);
        const LineMotion s2 = moved(now_, now_.v, a1, h_ / 2);
        const double a2 = pull(s2, force);
        const LineMotion s3 = moved(now_, s2.v, a2, h_ / 2);
        const double a3 = pull(s3, force);
        const LineMotion s4 = moved(now_, s3.v, a3, h_);
        const double a4 = pull(s4, force);
        now_.x += h_ / 6 * (now_.v + 2 * s2.v + 2 * s3.v + s4.v);
        now_.v += h_ / 6 * (a1 + 2 * a2 + 2 * a3 + a4);
        return;
      }
    }
  }

  Method method_;
  double h_;
  int substeps_;
  bool dry_;
  LineMotion now_;
};

/// Integrates it with the simulator's exact map.
class Exact {
 public:
  Exact(int substeps, bool dry)
      : dynamics_(
            device_sim::AxisDynamics::make(
                {.mass = Arm::kMass, .viscous = Arm::kViscous, .coulomb = dry ? Arm::kCoulomb : 0},
                hand_of(dry))
                .value()),
        substeps_(substeps) {}

  LineMotion tick(double force) noexcept {
    for (int i = 0; i < substeps_; ++i) {
      dynamics_.step(state_, {.force = force}, 1'000'000 / substeps_);
    }
    return {state_.x, state_.v};
  }

 private:
  static device_sim::HandSettings hand_of(bool dry) {
    device_sim::HandSettings hand;
    hand.mass = 0;
    hand.stiffness = dry ? 0 : Arm::kHandStiffness;
    hand.damping = dry ? 0 : Arm::kHandDamping;
    return hand;
  }
  device_sim::AxisDynamics dynamics_;
  device_sim::AxisState state_;
  int substeps_;
};

enum class Wrong { kPlace, kSpeed };

// Returns the largest error, um or mm/s.
template <class Any>
double error_of(Any motion, bool dry, Wrong wrong) {
  const std::vector<LineMotion> truth = dry ? pushed_with_dry_friction() : pushed_in_hand();
  double error = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const LineMotion now = motion.tick(pushing_forces()[i]);
    const double off = wrong == Wrong::kPlace ? 1e6 * std::abs(now.x - truth[i].x)
                                              : 1e3 * std::abs(now.v - truth[i].v);
    if (!(off < 1e9)) return NAN;
    error = std::max(error, off);
  }
  return error;
}

template <class Any>
Stroke work_of(Any motion) {
  const auto kept = std::make_shared<Any>(motion);
  return [kept] {
    double sum = 0;
    for (const double force : pushing_forces()) sum += kept->tick(force).x;
    return sum;
  };
}

struct Line {
  Method method;
  const char* name;
  const char* title;
  double order;
};

AccuracyAxis axis_of(bool dry, Wrong wrong) {
  AccuracyAxis axis;
  axis.knob = "time of a sub-step";
  axis.knob_unit = "us";
  if (wrong == Wrong::kPlace) {
    axis.metric = "largest position error in 1 s";
    axis.unit = "um";
    axis.threshold = 1;  // [PHYSICS 6]
    axis.threshold_words = "the smallest noticeable vibration (1 um)";
  } else {
    axis.metric = "largest velocity error in 1 s";
    axis.unit = "mm/s";
    axis.threshold = 20;  // [PHYSICS 6]
    axis.threshold_words = "20 mN from a damper of 1 N s/m";
  }
  const Line lines[] = {{Method::kEuler, "euler", "semi-implicit Euler", 1},
                        {Method::kMidpoint, "midpoint", "midpoint", 2},
                        {Method::kRungeKutta, "rk4", dry ? "RK4, smoothed friction" : "RK4", 4}};
  for (const Line& one : lines) {
    AccuracyLine line{.name = one.name, .title = one.title, .order = {}, .points = {}};
    // A step across the moment of a stop reduces the order of every method.
    if (!dry) line.order = one.order;
    for (int substeps = 1; substeps <= 64; substeps *= 2) {
      const Stepped motion(one.method, substeps, dry);
      line.points.push_back({.name = std::to_string(substeps),
                             .knob = 1e6 * Arm::kTick / substeps,
                             .error = [=] { return error_of(motion, dry, wrong); },
                             .prepare = [=] { return work_of(motion); },
                             .ticks = Arm::kTicks,
                             .fits = !dry && (one.order > 3 ? substeps <= 16 : substeps >= 8),
                             .law = {}});
    }
    axis.lines.push_back(std::move(line));
  }
  AccuracyLine exact{
      .name = "exact", .title = "exact map (product)", .order = {}, .exact = true, .points = {}};
  for (const int substeps : {1, 2, 4, 8, 16}) {
    exact.points.push_back({.name = std::to_string(substeps),
                            .knob = 1e6 * Arm::kTick / substeps,
                            .error = [=] { return error_of(Exact(substeps, dry), dry, wrong); },
                            .prepare = [=] { return work_of(Exact(substeps, dry)); },
                            .ticks = Arm::kTicks,
                            .is_default = substeps == 1,
                            .law = {}});
  }
  axis.lines.push_back(std::move(exact));
  return axis;
}

}  // namespace

AccuracyAxis simulator_axis() {
  AccuracyAxis axis = axis_of(true, Wrong::kPlace);
  axis.name = "simulator";
  axis.title = "Integrators of the simulated arm with dry friction, forces held for 1 ms";
  axis.truth =
      "The closed form of each slide and the time of its stop, in long double, "
      "without code of the simulator.";
  axis.left_out =
      "Orders: a step across a stop breaks the order of every method, so no order is "
      "checked here. The next diagram shows the orders without stops. RK4 needs a "
      "continuous friction, and keeps the error of that smoothing at any step.";
  return axis;
}

AccuracyAxis simulator_speed_axis() {
  AccuracyAxis axis = axis_of(true, Wrong::kSpeed);
  axis.name = "simulator_speed";
  axis.title = "Integrators of the simulated arm with dry friction: velocity";
  axis.truth = "The same closed form as for the position, in long double.";
  axis.left_out =
      "The case without dry friction, where velocity and position have similar "
      "errors.";
  return axis;
}

AccuracyAxis simulator_smooth_axis() {
  AccuracyAxis axis = axis_of(false, Wrong::kPlace);
  axis.name = "simulator_smooth";
  axis.title =
      "The same integrators without dry friction, with the spring and damper of a "
      "hand";
  axis.truth =
      "The closed form of the damped oscillator, from its complex root in long "
      "double.";
  axis.left_out = "The arm's other axes: they are independent, and each adds the same cost.";
  return axis;
}

}  // namespace thimble::studies
