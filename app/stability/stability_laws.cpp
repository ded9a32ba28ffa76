#include "stability/stability_laws.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace thimble::app {
namespace {

constexpr double kNone = std::numeric_limits<double>::infinity();
constexpr double kPi = std::numbers::pi;

/// How many angles are looked at in a maximum over angles; the maxima are broad.
constexpr int kAngles = 20'000;

/// Gives what a unit of stiffness and of damping ask of the device's friction at one angle.
struct AngleTerms {
  double stiffness = 0;  // s
  double damping = 0;    // 1
};

AngleTerms terms_at(double angle, double period, double delay) {
  const double d = delay / period;
  const double ratio = angle > 0 ? std::sin((d + 0.5) * angle) / std::sin(0.5 * angle) : 2 * d + 1;
  return {0.5 * period * ratio, -std::cos((1 + d) * angle)};
}

/// Finds exp(A) by halving, a series, and squaring; A is small.
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

/// Moves (x, v, motor force) and a held command by `time`: columns are the four unit states.
Eigen::Matrix4d plant_map(const SampledWall& wall, double time) {
  Eigen::Matrix4d rate = Eigen::Matrix4d::Zero();
  rate(0, 1) = 1;
  rate(1, 0) = -wall.hand_stiffness / wall.mass;
  rate(1, 1) = -wall.viscous / wall.mass;
  const int force = wall.amplifier_lag > 0 ? 2 : 3;
  rate(1, force) = 1 / wall.mass;
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
    (u * std::tan(u) < target ? low : high) = u;
  }
  const double u = 0.5 * (low + high);
  return damping / latency * (u > 1e-9 ? u / std::sin(u) : 1);
}

double passive_stiffness(double viscous, double wall_damping, double period, double delay) {
  // Each angle asks for K s + B w <= b: the least K over all angles with s > 0.
  double least = kNone;
  for (int i = 0; i <= kAngles; ++i) {
    const AngleTerms terms = terms_at(kPi * i / kAngles, period, delay);
    const double left = viscous - wall_damping * terms.damping;
    if (!(left >= 0) && !(terms.stiffness < 0)) return 0;
    if (terms.stiffness > 0) least = std::min(least, left / terms.stiffness);
  }
  return least;
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
  return std::exp(-kPi * (damping - stiffness * latency) / (2 * std::sqrt(stiffness * mass)));
}

double bristle_length(double friction_force, double latency, double damping, double encoder_step,
                      double coulomb) {
  // The factor covers the edge that encoder steps move out by up to 1.29 [PHYSICS 2.3].
  const double late = 1.5 * friction_force * latency / damping;
  const double coarse = encoder_step > 0 ? friction_force * encoder_step / (2 * coulomb) : 0;
  return std::max(late, coarse);
}

namespace {

/// Returns the largest absolute value of the matrix' eigenvalues, as the limit of |A^n|^(1/n)
/// (Gelfand's formula) at n = 2^60; not a number if an entry is none. Eigen's solver says the same,
/// and takes as long to build as all else here.
double spectral_radius(Eigen::MatrixXd power) {
  double exponent = 0, share = 1;
  for (int squared = 0; squared < 60; ++squared) {
    const double norm = power.norm();
    if (!(norm > 0) || !std::isfinite(norm)) return norm;
    exponent += share * std::log(norm);
    power /= norm;
    power = power.lazyProduct(power).eval();
    share *= 0.5;
  }
  return std::exp(exponent);
}

}  // namespace

double growth_per_tick(const SampledWall& wall) {
  const int whole = static_cast<int>(std::floor(wall.delay / wall.period + 1e-9));
  const double rest = std::max(0.0, wall.delay - whole * wall.period);
  const Eigen::Matrix4d before = plant_map(wall, rest);
  const Eigen::Matrix4d after = plant_map(wall, wall.period - rest);
  const double gain =
      wall.velocity_corner > 0 ? -std::expm1(-2 * kPi * wall.velocity_corner * wall.period) : 1;
  // One entry each for x, v, motor force, last x, velocity estimate, and the commands on their way,
  // the newest first.
  const int size = 5 + whole + 1;
  Eigen::MatrixXd tick(size, size);
  for (int column = 0; column < size; ++column) {
    Eigen::VectorXd state = Eigen::VectorXd::Unit(size, column);
    const double x = state[0];
    const double estimate = state[4] + gain * ((x - state[3]) / wall.period - state[4]);
    const double command = -wall.stiffness * x - wall.damping * estimate;
    Eigen::Vector4d plant(state[0], state[1], state[2], state[5 + whole]);
    plant = before * plant;
    plant[3] = whole == 0 ? command : state[5 + whole - 1];
    plant = after * plant;
    for (int i = whole; i > 0; --i) state[5 + i] = state[5 + i - 1];
    state[5] = command;
    state.head<3>() = plant.head<3>();
    if (!(wall.amplifier_lag > 0)) state[2] = 0;
    state[3] = x;
    state[4] = estimate;
    tick.col(column) = state;
  }
  // The same map of states all in metres, whose entries lie not far apart.
  const double of_velocity = wall.period, of_force = wall.period * wall.period / wall.mass;
  Eigen::VectorXd metres = Eigen::VectorXd::Constant(size, of_force);
  metres.head<5>() << 1, of_velocity, of_force, 1, of_velocity;
  return spectral_radius(metres.asDiagonal() * tick * metres.cwiseInverse().asDiagonal());
}

double stiffness_edge(SampledWall wall) {
  const auto grows = [&wall](double stiffness) {
    wall.stiffness = stiffness;
    // Written so that NaN grows.
    return !(growth_per_tick(wall) < 1);
  };
  double low = 0, high = 1;  // N/m
  if (grows(high)) return 0;
  while (high < 1e9 && !grows(high)) {
    low = high;
    high *= 2;
  }
  while (high - low > 1e-6 * high) {
    const double middle = 0.5 * (low + high);
    (grows(middle) ? high : low) = middle;
  }
  return low;
}

}  // namespace thimble::app
