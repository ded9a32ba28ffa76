#include "stability/stability_laws.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "math/elementary.h"

namespace thimble::stability {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;

/// Number of angles evaluated for a maximum over angles; the maxima are broad.
constexpr int kAngles = 20'000;

/// Friction of the device that a unit of stiffness and of damping requires at one angle.
struct AngleTerms {
  double stiffness = 0;  // s
  double damping = 0;    // 1
};

AngleTerms terms_at(double angle, double period, double delay) {
  const double d = delay / period;
  const double ratio =
      angle > 0 ? math::sin((d + 0.5) * angle) / math::sin(0.5 * angle) : 2 * d + 1;
  return {0.5 * period * ratio, -math::cos((1 + d) * angle)};
}

/// Computes exp(A) by halving, a series, and squaring; A is small.
Eigen::MatrixXd exponential(const Eigen::MatrixXd& A) {
  const int halvings = std::max(0, 2 + std::ilogb(std::max(1e-9, A.cwiseAbs().sum())));
  const Eigen::MatrixXd small = A * std::ldexp(1.0, -halvings);
  Eigen::MatrixXd term = Eigen::MatrixXd::Identity(A.rows(), A.cols());
  Eigen::MatrixXd sum = term;
  for (int k = 1; k <= 16; ++k) {
    term = term * small / k;
    sum += term;
  }
  for (int k = 0; k < halvings; ++k) sum = sum * sum;
  return sum;
}

/// Moves (x, v, motor force), a held command, and the motor's own (x, v) by `time`: columns are the
/// unit states. The motor's are used only with an elastic cable.
Eigen::MatrixXd plant_map(const SampledWall& wall, double time) {
  const bool stretches = wall.cable_stiffness > 0;
  Eigen::MatrixXd rate = Eigen::MatrixXd::Zero(stretches ? 6 : 4, stretches ? 6 : 4);
  rate(0, 1) = 1;
  rate(1, 0) = -wall.hand_stiffness / wall.mass;
  rate(1, 1) = -wall.viscous / wall.mass;
  const int force = wall.amplifier_lag > 0 ? 2 : 3;
  if (stretches) {
    rate(4, 5) = 1;
    // Force of the cable on the tip (rows 0 and 1) and the motor (4 and 5).
    for (const int x : {0, 4}) {
      const double per_mass = 1 / (x == 0 ? wall.mass : wall.rotor_mass);
      const int other = 4 - x;
      rate(x + 1, x) -= wall.cable_stiffness * per_mass;
      rate(x + 1, x + 1) -= wall.cable_damping * per_mass;
      rate(x + 1, other) += wall.cable_stiffness * per_mass;
      rate(x + 1, other + 1) += wall.cable_damping * per_mass;
    }
    rate(5, force) = 1 / wall.rotor_mass;
  } else {
    rate(1, force) = 1 / wall.mass;
  }
  if (wall.amplifier_lag > 0) {
    rate(2, 2) = -1 / wall.amplifier_lag;
    rate(2, 3) = 1 / wall.amplifier_lag;
  }
  return exponential(rate * time);
}

}  // namespace

double late_stiffness_limit(double damping, double latency, double mass) {
  const double target = damping * latency / mass;
  double low = 0, high = kPi / 2;
  for (int i = 0; i < 60; ++i) {
    const double u = 0.5 * (low + high);
    (u * math::tan(u) < target ? low : high) = u;
  }
  const double u = 0.5 * (low + high);
  return damping / latency * (u > 1e-9 ? u / math::sin(u) : 1);
}

double passive_stiffness(double viscous, double wall_damping, double period, double delay) {
  // Each angle requires K s + B w <= b: the min. K over all angles with s > 0.
  double min = kNone;
  for (int i = 0; i <= kAngles; ++i) {
    const AngleTerms terms = terms_at(kPi * i / kAngles, period, delay);
    const double left = viscous - wall_damping * terms.damping;
    if (!(left >= 0) && !(terms.stiffness < 0)) return 0;
    if (terms.stiffness > 0) min = std::min(min, left / terms.stiffness);
  }
  return min;
}

double passive_stiffness_quantised(double viscous, double coulomb, double encoder_step,
                                   double period) {
  const double held = 2 * viscous / period;
  return encoder_step > 0 ? std::min(held, 2 * coulomb / encoder_step) : held;
}

double oscillation_speed_limit(double stiffness, double viscous, double coulomb, double latency) {
  const double leak = stiffness * latency - viscous;
  return leak > 0 ? 4 / kPi * coulomb / leak : kNone;
}

double restitution(double stiffness, double damping, double mass, double latency) {
  return math::exp(-kPi * (damping - stiffness * latency) / (2 * std::sqrt(stiffness * mass)));
}

double bristle_length(double friction_force, double latency, double damping, double encoder_step,
                      double coulomb) {
  // The factor covers the edge that encoder steps extend by up to 1.29 [PHYSICS 2.3].
  const double late = 1.5 * friction_force * latency / damping;
  const double coarse = encoder_step > 0 ? friction_force * encoder_step / (2 * coulomb) : 0;
  return std::max(late, coarse);
}

namespace {

/// Returns the largest absolute value of the matrix' eigenvalues, as the limit of |A^n|^(1/n)
/// (Gelfand's formula) at n = 2^60; not a number if an entry is none. Eigen's solver gives the
/// same, but takes as long to compile as all other code here.
double spectral_radius(Eigen::MatrixXd power) {
  double exponent = 0, share = 1;
  for (int squared = 0; squared < 60; ++squared) {
    const double norm = power.norm();
    if (!(norm > 0) || !std::isfinite(norm)) return norm;
    exponent += share * math::log(norm);
    power /= norm;
    power = power.lazyProduct(power).eval();
    share *= 0.5;
  }
  return math::exp(exponent);
}

}  // namespace

double growth_per_tick(const SampledWall& wall) {
  const int whole = static_cast<int>(std::floor(wall.delay / wall.period + 1e-9));
  const double rest = std::max(0.0, wall.delay - whole * wall.period);
  const Eigen::MatrixXd before = plant_map(wall, rest);
  const Eigen::MatrixXd after = plant_map(wall, wall.period - rest);
  const double gain =
      wall.velocity_corner > 0 ? -math::expm1(-2 * kPi * wall.velocity_corner * wall.period) : 1;
  // One entry each for x, v, motor force, last x, velocity estimate, the motor's x and v if its
  // cable is elastic, and the commands in flight, newest first.
  const bool stretches = wall.cable_stiffness > 0;
  const int sent = stretches ? 7 : 5;
  const int size = sent + whole + 1;
  Eigen::MatrixXd tick(size, size);
  for (int column = 0; column < size; ++column) {
    Eigen::VectorXd state = Eigen::VectorXd::Unit(size, column);
    const double x = state[stretches ? 5 : 0];
    const double estimate = state[4] + gain * ((x - state[3]) / wall.period - state[4]);
    const double command = -wall.stiffness * x - wall.damping * estimate;
    Eigen::VectorXd plant(before.rows());
    plant.head<4>() << state[0], state[1], state[2], state[sent + whole];
    if (stretches) plant.tail<2>() = state.segment<2>(5);
    plant = before * plant;
    plant[3] = whole == 0 ? command : state[sent + whole - 1];
    plant = after * plant;
    for (int i = whole; i > 0; --i) state[sent + i] = state[sent + i - 1];
    state[sent] = command;
    state.head<3>() = plant.head<3>();
    if (stretches) state.segment<2>(5) = plant.tail<2>();
    if (!(wall.amplifier_lag > 0)) state[2] = 0;
    state[3] = x;
    state[4] = estimate;
    tick.col(column) = state;
  }
  // The same map with all states in metres, whose entries are of similar size.
  const double of_velocity = wall.period, of_force = wall.period * wall.period / wall.mass;
  Eigen::VectorXd metres = Eigen::VectorXd::Constant(size, of_force);
  metres.head<5>() << 1, of_velocity, of_force, 1, of_velocity;
  if (stretches) metres.segment<2>(5) << 1, of_velocity;
  return spectral_radius(metres.asDiagonal() * tick * metres.cwiseInverse().asDiagonal());
}

double limit_by_phase(const SampledWall& wall) {
  using Complex = std::complex<double>;
  const double latency = 0.5 * wall.period + wall.delay + wall.amplifier_lag;
  // The required stiffness, rotated back by the latency: real where one exists.
  const auto needed = [&](double w) {
    const Complex tip(wall.hand_stiffness - w * w * wall.mass, w * wall.viscous);
    Complex arm = tip;
    if (wall.cable_stiffness > 0) {
      const Complex cable(wall.cable_stiffness, w * wall.cable_damping);
      arm = cable * tip / (cable + tip) - w * w * wall.rotor_mass;
    }
    const double half = 0.5 * w * wall.period;
    const Complex late(math::cos(w * latency), math::sin(w * latency));
    return -arm * (half / math::sin(half)) * late;
  };
  const double highest = kPi / wall.period;  // half the rate
  double min = 0;
  double below = highest / kAngles;
  for (int i = 2; i <= kAngles; ++i) {
    const double above = highest * i / kAngles;
    if ((needed(below).imag() < 0) != (needed(above).imag() < 0)) {
      double low = below, high = above;
      const bool sign = needed(low).imag() < 0;
      for (int half = 0; half < 50; ++half) {
        const double middle = 0.5 * (low + high);
        ((needed(middle).imag() < 0) == sign ? low : high) = middle;
      }
      const double stiffness = needed(low).real();
      if (stiffness > 0 && (min == 0 || stiffness < min)) min = stiffness;
    }
    below = above;
  }
  return min;
}

double stiffness_edge(SampledWall wall) {
  const auto grows = [&wall](double stiffness) {
    wall.stiffness = stiffness;
    // Written so that NaN counts as growing.
    return !(growth_per_tick(wall) < 1);
  };
  const double band = wall.cable_stiffness > 0 ? 1.02 * limit_by_phase(wall) : 0;
  double low = 0, high = 1;  // N/m
  if (grows(high)) return 0;
  while (high < 1e9 && !grows(high)) {
    low = high;
    high *= 2;
    if (low < band && band < high && grows(band)) high = band;
  }
  while (high - low > 1e-6 * high) {
    const double middle = 0.5 * (low + high);
    (grows(middle) ? high : low) = middle;
  }
  return low;
}

}  // namespace thimble::stability
