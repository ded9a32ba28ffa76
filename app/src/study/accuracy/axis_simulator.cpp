#include <algorithm>
#include <cmath>
#include <complex>
#include <memory>
#include <string>
#include <vector>

#include "study/accuracy/axes.h"
#include "study/draw.h"
#include "thimble/device_sim/axis_dynamics.h"

namespace thimble::app {
namespace {

// One axis of the PHANTOM-like arm [STABILITY, heading], pushed by a force that a servo loop holds
// for 1 ms each.
constexpr double kMass = 0.075;     // kg
constexpr double kViscous = 0.005;  // N s/m
constexpr double kCoulomb = 0.04;   // N
constexpr double kTick = 1e-3;      // s
constexpr int kTicks = 1000;
constexpr double kHandStiffness = 300;  // N/m, of the smooth case
constexpr double kHandDamping = 3;      // N s/m

// The forces of the motors, N: steps of up to 0.25 N around 0, each held for 20 to 60 ms.
const std::vector<double>& forces() {
  static const std::vector<double> all = [] {
    std::vector<double> list;
    Draw draw(9);
    while (list.size() < kTicks) {
      const double force = draw.uniform(-0.25, 0.25);
      const auto ticks = static_cast<std::size_t>(draw.uniform(20, 60));
      for (std::size_t i = 0; i < ticks && list.size() < kTicks; ++i) list.push_back(force);
    }
    return list;
  }();
  return all;
}

struct Moving {
  double x = 0, v = 0;
};

// The truth with dry friction: m v' = f - b v - c sgn v in closed form, and the time at which v
// comes to zero as well, in long double. No code is shared with the simulator.
Moving true_step(long double x, long double v, long double f) {
  const long double m = kMass;
  const long double b = kViscous;
  const long double c = kCoulomb;
  long double left = kTick;
  for (int event = 0; event < 4 && left > 0; ++event) {
    if (v == 0 && std::abs(f) <= c) break;
    const long double sign = v != 0 ? (v > 0 ? 1 : -1) : (f > 0 ? 1 : -1);
    const long double u = (f - c * sign) / b;  // m/s, towards which it goes
    // v + (u - v) (1 - exp(-b t / m)) = 0, if u has the other sign.
    long double t = left;
    bool stops = false;
    if (v != 0 && u * sign < 0) {
      const long double stop = -m / b * std::log(u / (u - v));
      if (stop < left) {
        t = stop;
        stops = true;
      }
    }
    const long double fade = -std::expm1(-b * t / m);
    x += u * t + (v - u) * m / b * fade;
    v = stops ? 0 : v + (u - v) * fade;
    left -= t;
  }
  return {static_cast<double>(x), static_cast<double>(v)};
}

std::vector<double> dry_truth() {
  std::vector<double> places;
  long double x = 0;
  long double v = 0;
  for (const double f : forces()) {
    const Moving now = true_step(x, v, f);
    x = now.x;
    v = now.v;
    places.push_back(now.x);
  }
  return places;
}

// The truth of the smooth case: x = f / k + re(A exp(s t)), by the complex root s.
std::vector<double> smooth_truth() {
  using Complex = std::complex<long double>;
  std::vector<double> places;
  const long double decay = (kViscous + kHandDamping) / (2 * kMass);
  const long double omega =
      std::sqrt(kHandStiffness / static_cast<long double>(kMass) - decay * decay);
  const Complex root(-decay, omega);
  const Complex turn = std::exp(root * static_cast<long double>(kTick));
  long double x = 0;
  long double v = 0;
  for (const double f : forces()) {
    const long double rest = f / static_cast<long double>(kHandStiffness);
    const Complex amplitude(x - rest, -(v + decay * (x - rest)) / omega);
    const Complex next = amplitude * turn;
    x = rest + next.real();
    v = (next * root).real();
    places.push_back(static_cast<double>(x));
  }
  return places;
}

enum class Method { kEuler, kMidpoint, kRungeKutta };

/// Steps the same motion by what textbooks offer.
class Stepped {
 public:
  Stepped(Method method, int substeps, bool dry)
      : method_(method), h_(kTick / substeps), substeps_(substeps), dry_(dry) {}

  double tick(double force) noexcept {
    for (int i = 0; i < substeps_; ++i) step(force);
    return now_.x;
  }

 private:
  // Dry friction for methods that take several looks per step: smoothed at 1 mm/s.
  double pull(const Moving& at, double force) const noexcept {
    double f = force - kViscous * at.v;
    if (dry_) return (f - kCoulomb * std::tanh(at.v / 1e-3)) / kMass;
    f -= kHandStiffness * at.x + kHandDamping * at.v;
    return f / kMass;
  }
  // Dry friction that stops at zero and no farther.
  double rubbed(double v, double time) const noexcept {
    if (!dry_) return v;
    const double most = kCoulomb / kMass * time;
    return v > most ? v - most : v < -most ? v + most : 0;
  }
  double smooth_pull(const Moving& at, double force) const noexcept {
    double f = force - kViscous * at.v;
    if (!dry_) f -= kHandStiffness * at.x + kHandDamping * at.v;
    return f / kMass;
  }
  static Moving moved(const Moving& at, double v, double a, double time) noexcept {
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
        const Moving half{now_.x + h_ / 2 * now_.v,
                          rubbed(now_.v + h_ / 2 * smooth_pull(now_, force), h_ / 2)};
        const double a = smooth_pull(half, force);
        now_.x += h_ * half.v;
        now_.v = rubbed(now_.v + h_ * a, h_);
        return;
      }
      case Method::kRungeKutta: {
        const double a1 = pull(now_, force);
        const Moving s2 = moved(now_, now_.v, a1, h_ / 2);
        const double a2 = pull(s2, force);
        const Moving s3 = moved(now_, s2.v, a2, h_ / 2);
        const double a3 = pull(s3, force);
        const Moving s4 = moved(now_, s3.v, a3, h_);
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
  Moving now_;
};

/// Steps it by the simulator's own exact map.
class Exact {
 public:
  Exact(int substeps, bool dry)
      : dynamics_({.mass = kMass, .viscous = kViscous, .coulomb = dry ? kCoulomb : 0},
                  hand_of(dry)),
        substeps_(substeps) {}

  double tick(double force) noexcept {
    for (int i = 0; i < substeps_; ++i) {
      dynamics_.step(state_, {.force = force}, 1'000'000 / substeps_);
    }
    return state_.x;
  }

 private:
  static device_sim::HandSettings hand_of(bool dry) {
    device_sim::HandSettings hand;
    hand.mass = 0;
    hand.stiffness = dry ? 0 : kHandStiffness;
    hand.damping = dry ? 0 : kHandDamping;
    return hand;
  }
  device_sim::AxisDynamics dynamics_;
  device_sim::AxisState state_;
  int substeps_;
};

// The largest error of the place, um.
template <class Any>
double error_of(Any motion, bool dry) {
  const std::vector<double> truth = dry ? dry_truth() : smooth_truth();
  double error = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double off = std::abs(motion.tick(forces()[i]) - truth[i]);
    if (!(off < 1e3)) return NAN;
    error = std::max(error, off);
  }
  return 1e6 * error;
}

template <class Any>
Stroke work_of(Any motion) {
  const auto kept = std::make_shared<Any>(motion);
  return [kept] {
    double sum = 0;
    for (const double force : forces()) sum += kept->tick(force);
    return sum;
  };
}

struct Line {
  Method method;
  const char* name;
  const char* title;
  double order;
};

AccuracyAxis axis_of(bool dry) {
  AccuracyAxis axis;
  axis.knob = "time of a sub-step";
  axis.knob_unit = "us";
  axis.metric = "largest error of the place in 1 s";
  axis.unit = "um";
  axis.threshold = 1;  // [STABILITY 6]
  axis.threshold_words = "the smallest vibration that is felt (1 um at 100 Hz)";
  const Line lines[] = {{Method::kEuler, "euler", "semi-implicit Euler", 1},
                        {Method::kMidpoint, "midpoint", "midpoint", 2},
                        {Method::kRungeKutta, "rk4", dry ? "RK4, smoothed friction" : "RK4", 4}};
  for (const Line& one : lines) {
    AccuracyLine line{.name = one.name, .title = one.title, .order = {}, .points = {}};
    // A step that jumps over the moment of a stop costs every method its order.
    if (!dry) line.order = one.order;
    for (int substeps = 1; substeps <= 64; substeps *= 2) {
      const Stepped motion(one.method, substeps, dry);
      line.points.push_back({.name = std::to_string(substeps),
                             .knob = 1e6 * kTick / substeps,
                             .error = [=] { return error_of(motion, dry); },
                             .prepare = [=] { return work_of(motion); },
                             .ticks = kTicks,
                             .fits = !dry && (one.order > 3 ? substeps <= 16 : substeps >= 8),
                             .law = {}});
    }
    axis.lines.push_back(std::move(line));
  }
  AccuracyLine exact{
      .name = "exact", .title = "exact map (product)", .order = {}, .exact = true, .points = {}};
  for (const int substeps : {1, 2, 4, 8, 16}) {
    exact.points.push_back({.name = std::to_string(substeps),
                            .knob = 1e6 * kTick / substeps,
                            .error = [=] { return error_of(Exact(substeps, dry), dry); },
                            .prepare = [=] { return work_of(Exact(substeps, dry)); },
                            .ticks = kTicks,
                            .is_default = substeps == 1,
                            .law = {}});
  }
  axis.lines.push_back(std::move(exact));
  return axis;
}

}  // namespace

AccuracyAxis simulator_axis() {
  AccuracyAxis axis = axis_of(true);
  axis.name = "simulator";
  axis.title = "Integrators of the simulated arm with dry friction, forces held for 1 ms";
  axis.truth =
      "The closed form of each slide with the time of its stop, in long double, sharing no code "
      "with "
      "the simulator.";
  axis.left_out =
      "Orders: a step that jumps over the moment of a stop costs every method its order, so none "
      "is "
      "asked for here; the same methods show them where nothing stops (next diagram). RK4 needs a "
      "friction without a jump, and keeps the error of that at any cost.";
  return axis;
}

AccuracyAxis simulator_smooth_axis() {
  AccuracyAxis axis = axis_of(false);
  axis.name = "simulator_smooth";
  axis.title = "The same integrators without dry friction, in a hand's spring and damper";
  axis.truth = "The closed form of the damped oscillator by its complex root, in long double.";
  axis.left_out = "The arm's other axes: each moves on its own, and costs the same again.";
  return axis;
}

}  // namespace thimble::app
