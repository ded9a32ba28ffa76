#include "bringup/identify/cables/cables.h"

#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <unsupported/Eigen/FFT>

#include "math/elementary.h"

namespace thimble::bringup {
namespace {

using Complex = std::complex<double>;
using Wave = std::vector<Complex>;

constexpr double kWhole = 90, kNone = 150;  // Hz; between them the gain fades [chosen: far above
                                            // the band that 60 ms of smoothing leave]
constexpr double kEnds = 0.5;               // s, affected by the ends of the record

/// A series without the straight line between its ends, which a transform would treat as a step.
struct Leant {
  Wave wave;
  double first = 0, rise = 0;  // of the line, per tick

  explicit Leant(const std::vector<double>& series) {
    first = series.front();
    rise = (series.back() - first) / static_cast<double>(series.size() - 1);
    std::vector<double> rest(series);
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= at(i);
    Eigen::FFT<double> transform;
    transform.fwd(wave, rest);
  }

  double at(std::size_t i) const { return first + rise * static_cast<double>(i); }
};

std::vector<double> series_of(const Wave& wave) {
  Eigen::FFT<double> transform;
  std::vector<double> series;
  transform.inv(series, wave);
  return series;
}

double kept(double hz) {
  if (hz < kWhole) return 1;
  if (hz > kNone) return 0;
  return 0.5 + 0.5 * math::cos(std::numbers::pi * (hz - kWhole) / (kNone - kWhole));
}

/// Returns the frequency of an element of a transform, Hz.
double hertz(std::size_t i, std::size_t count, double dt) {
  const auto k = static_cast<double>(i <= count / 2 ? i : count - i);
  return k / (static_cast<double>(count) * dt);
}

/// Returns i times its angular frequency, rad/s.
Complex laplace(std::size_t i, std::size_t count, double dt) {
  const double sign = i <= count / 2 ? 1 : -1;
  return {0, sign * 2 * std::numbers::pi * hertz(i, count, dt)};
}

/// Conversion of a joint's torque and angle to the effect of its cable on the link: torque of an
/// equal motor without inertia, and angle.
struct JointOfLink {
  std::vector<double> tau, q, ddq;
};

/// Returns the transform of the friction torque of a motor, whose angles' transform is `turned`, in
/// the middle of each tick.
Wave rubbed(const Wave& turned, double viscous, double coulomb, double dt) {
  const std::size_t count = turned.size();
  Wave rate(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Complex s = laplace(i, count, dt);
    rate[i] = kept(hertz(i, count, dt)) * s * turned[i] * turn_by(0.5 * s.imag() * dt);
  }
  std::vector<double> torque = series_of(rate);
  for (double& one : torque) {
    one = viscous * one + coulomb * (one > 0 ? 1.0 : one < 0 ? -1.0 : 0.0);
  }
  Wave wave;
  Eigen::FFT<double> transform;
  transform.fwd(wave, torque);
  return wave;
}

JointOfLink behind_cable(const ArmMotion& motion, const CableFit& cables, int joint) {
  const TwoMass& fit = cables.elastic;
  const std::size_t count = motion.samples.size();
  std::vector<double> tau(count), q(count);
  for (std::size_t i = 0; i < count; ++i) {
    tau[i] = motion.samples[i].tau[joint];
    q[i] = motion.samples[i].q[joint];
  }
  Leant pushed(tau), turned(q);
  Wave faster(count);
  const double gain = fit.theta[TwoMass::kGain + joint];
  const double inertia = fit.theta[TwoMass::kInertia + joint];
  const double compliance = fit.theta[TwoMass::kCompliance + joint];
  const double fade = fit.theta[TwoMass::kFade + joint];
  const double viscous = cables.rotor_viscous[joint], coulomb = cables.rotor_coulomb[joint];
  Wave rubs;
  if (viscous != 0 || coulomb != 0) rubs = rubbed(turned.wave, viscous, coulomb, motion.dt);
  for (std::size_t i = 0; i < count; ++i) {
    const Complex s = laplace(i, count, motion.dt);
    // The torque of a tick is its mean over the delayed tick.
    Complex pull = gain * turn_by(-s.imag() * fit.theta[TwoMass::kDelay]) * pushed.wave[i] -
                   inertia * s * s * turned.wave[i] * turn_by(0.5 * s.imag() * motion.dt);
    if (!rubs.empty()) pull -= rubs[i];
    const double share = kept(hertz(i, count, motion.dt));
    faster[i] = share * s * s * turned.wave[i] * turn_by(0.5 * s.imag() * motion.dt);
    turned.wave[i] = share * (turned.wave[i] - compliance / (1.0 + fade * s) * pull *
                                                   turn_by(-0.5 * s.imag() * motion.dt));
    pushed.wave[i] = share * pull / gain;
  }
  JointOfLink link{series_of(pushed.wave), series_of(turned.wave), series_of(faster)};
  for (std::size_t i = 0; i < count; ++i) {
    // The lines that were removed bend nothing: a constant torque stretches the cable.
    link.tau[i] += pushed.at(i);
    link.q[i] += turned.at(i) - compliance * gain * pushed.at(i);
  }
  return link;
}

}  // namespace

std::array<CableConstants, 3> cable_constants(const CableFit& fit,
                                              const std::array<Estimate, 3>& gain) {
  std::array<CableConstants, 3> found;
  const auto& theta = fit.elastic.theta;
  const auto& covariance = fit.elastic.covariance;
  for (int i = 0; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    using TwoMassSlope = Eigen::Matrix<double, TwoMass::kCount, 1>;
    // Each is a product of powers, so its relative error is a sum of theirs.
    const auto estimate = [&](double value, const TwoMassSlope& relative, double of_gain) {
      TwoMassSlope slope = relative;
      for (int j = 0; j < TwoMass::kCount; ++j) slope[j] /= theta[j] != 0 ? theta[j] : 1;
      const double error = kNormal95 * std::sqrt(slope.dot(covariance * slope));
      return Estimate{value, std::abs(value) *
                                 math::hypot(error, of_gain * gain[k].plus_minus / gain[k].value)};
    };
    const auto power = [](std::initializer_list<std::pair<int, double>> powers) {
      TwoMassSlope slope = TwoMassSlope::Zero();
      for (const auto& [index, by] : powers) slope[index] = by;
      return slope;
    };
    const int g = TwoMass::kGain + i, J = TwoMass::kInertia + i, c = TwoMass::kCompliance + i;
    const int t = TwoMass::kFade + i;
    const double scale = gain[k].value / theta[g];
    found[k].inertia = estimate(scale * theta[J], power({{J, 1}, {g, -1}}), 1);
    found[k].stiffness = estimate(scale / theta[c], power({{c, -1}, {g, -1}}), 1);
    found[k].damping = estimate(scale * theta[t] / theta[c], power({{t, 1}, {c, -1}, {g, -1}}), 1);
    found[k].antiresonance = estimate(fit.elastic.antiresonance(i, fit.JTJ), power({{c, -0.5}}), 0);
    const double link = fit.JTJ(i, i), rotor = theta[J];
    found[k].resonance = estimate(fit.elastic.resonance(i, fit.JTJ),
                                  power({{c, -0.5}, {J, -0.5 * link / (link + rotor)}}), 0);
  }
  return found;
}

driver::Result<ArmMotion> motion_of_links(const ArmMotion& motion, const CableFit& fit,
                                          const scene::ArmFile& file) {
  // A number of ticks with small prime factors, which makes transforms fast.
  ArmMotion whole = motion;
  const auto over = static_cast<std::ptrdiff_t>(motion.samples.size() % 500);
  whole.samples.erase(whole.samples.begin(), whole.samples.begin() + over);
  std::array<JointOfLink, 3> links;
  for (int joint = 0; joint < 3; ++joint) {
    links[static_cast<std::size_t>(joint)] = behind_cable(whole, fit, joint);
  }
  ArmMotion seen = whole;
  const auto ends = static_cast<std::size_t>(std::llround(kEnds / motion.dt));
  seen.samples.clear();
  for (std::size_t i = ends; i + ends < whole.samples.size(); ++i) {
    MotionSample sample = whole.samples[i];
    Eigen::Matrix3d J;
    for (int joint = 0; joint < 3; ++joint) {
      const JointOfLink& link = links[static_cast<std::size_t>(joint)];
      sample.q[joint] = link.q[i];
      sample.tau[joint] = link.tau[i + kDelayTicks];
      sample.ddq[joint] = link.ddq[i + kDelayTicks];
    }
    std::visit([&](const auto& build) { build.forward(sample.q, sample.p_BT, J); },
               file.model.geometry);
    sample.G = J.inverse();
    if (!sample.p_BT.allFinite() || !sample.G.allFinite()) {
      return driver::Error{
          "The cables found would put the links out of reach, so they are not the arm's cables."};
    }
    seen.samples.push_back(sample);
  }
  return seen;
}

}  // namespace thimble::bringup
