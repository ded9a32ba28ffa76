#include "bringup/identify/link_inertia/link_equations.h"

#include <Eigen/LU>
#include <array>

#include "bringup/identify/arm_constants.h"
#include "gravity_terms.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

constexpr int kRateTicks = 10;  // ticks to either side, as in MotionEquations for the tip
constexpr int kLeverTicks = 2;  // ticks to either side, for changes of levers
// The joint of each inertia.
constexpr std::array<Eigen::Index, 5> kJointOfInertia = {0, 1, 2, 0, 0};

}  // namespace

LinkEquations::LinkEquations(const ArmMotion& motion)
    : moment_{.height = 0, .length_b = 1, .length_c = 0}, motion_(motion), bump_(motion.dt) {
  for (const double value : bump_.value) area_ += value;
  for (const double value : bump_.curvature) curvature_ += value * value;
  const TurnSmoothing<kRateTicks> smooth(motion.dt);
  levers_.reserve(motion.samples.size());
  pulled_.reserve(motion.samples.size());
  for (const MotionSample& sample : motion.samples) {
    levers_.push_back(levers_of(sample));
    pulled_.push_back(sample.G.transpose() * moment_.jacobian(sample.q).transpose() *
                      (scene::kGravity * motion.down_B));
  }
  rate_.assign(motion.samples.size(), Eigen::Vector3d::Zero());
  const int end = static_cast<int>(motion.samples.size()) - kRateTicks;
  for (int k = kRateTicks; k < end; ++k) {
    Eigen::Vector3d sum(0, 0, 0);
    for (int j = -kRateTicks; j <= kRateTicks; ++j) {
      sum -= smooth.slope[static_cast<std::size_t>(j + kRateTicks)] * (at(k + j).q - at(k).q);
    }
    rate_[static_cast<std::size_t>(k)] = sum;
  }
}

LinkEquations::Levers LinkEquations::levers_of(const MotionSample& sample) {
  const double sin_b = math::sin(sample.q[1]), sin_c = math::sin(sample.q[2]);
  Levers levers;
  levers.topRows<3>() = sample.G;
  levers.row(kYawB) = sin_b * sin_b * sample.G.row(0);
  levers.row(kYawC) = sin_c * sin_c * sample.G.row(0);
  return levers;
}

LinkEquations::Inertias LinkEquations::turning(int tick, int axis) const {
  const MotionSample& sample = at(tick);
  const Eigen::Vector3d& rate = rate_[static_cast<std::size_t>(tick)];
  const Eigen::Vector3d along = sample.G.col(axis);
  // Half of the derivative of sin^2 by its angle.
  const double by_b = math::sin(sample.q[1]) * math::cos(sample.q[1]);
  const double by_c = math::sin(sample.q[2]) * math::cos(sample.q[2]);
  const double a = rate[0];
  Inertias forces = Inertias::Zero();
  forces[kYawB] = by_b * a * (2 * along[0] * rate[1] - along[1] * a);
  forces[kYawC] = by_c * a * (2 * along[0] * rate[2] - along[2] * a);
  return forces;
}

LinkEquations::Row LinkEquations::row(const MotionEquations::Equation& equation) const {
  const int middle = equation.middle, axis = equation.axis;
  const Inertias there = levers_[static_cast<std::size_t>(middle)].col(axis);
  Inertias sum = Inertias::Zero();
  double weight = 0;
  Eigen::Vector3d curved(0, 0, 0);
  for (int j = -kHalf; j <= kHalf; ++j) {
    const auto i = static_cast<std::size_t>(j + kHalf);
    const int tick = middle + j;
    curved += bump_.curvature[i] * (at(tick).q - at(middle).q);
    // By parts, the change of the lever within the bump; both are small at its ends.
    const Inertias rise = (levers_[static_cast<std::size_t>(tick + kLeverTicks)].col(axis) -
                           levers_[static_cast<std::size_t>(tick - kLeverTicks)].col(axis)) /
                          (2 * kLeverTicks * motion_.dt);
    const Inertias by_rate =
        bump_.slope[i] * (levers_[static_cast<std::size_t>(tick)].col(axis) - there) +
        bump_.value[i] * rise;
    for (Eigen::Index l = 0; l < 5; ++l) {
      sum[l] -= by_rate[l] *
                rate_[static_cast<std::size_t>(tick)][kJointOfInertia[static_cast<std::size_t>(l)]];
    }
    sum += bump_.value[i] * turning(tick, axis);
    weight += bump_.value[i] * pulled_[static_cast<std::size_t>(tick)][axis];
  }
  for (Eigen::Index l = 0; l < 5; ++l) {
    sum[l] += there[l] * curved[kJointOfInertia[static_cast<std::size_t>(l)]];
  }
  Row row;
  row << sum, -weight;
  return row / area_;
}

LinkEquations::StepNoise LinkEquations::step_noise(
    const MotionEquations::Equation& equation) const {
  // Second derivatives contain nearly all of the noise; joints enter them by these factors.
  Eigen::Matrix<double, 6, 3> factor = Eigen::Matrix<double, 6, 3>::Zero();
  factor.row(0) = at(equation.middle).G.inverse().row(equation.axis);
  const Inertias there = levers_[static_cast<std::size_t>(equation.middle)].col(equation.axis);
  for (Eigen::Index l = 0; l < 5; ++l) {
    factor(1 + l, kJointOfInertia[static_cast<std::size_t>(l)]) = there[l];
  }
  const Eigen::Vector3d variance = motion_.step.cwiseAbs2() / 12;
  return curvature_ / (area_ * area_) * (factor * variance.asDiagonal() * factor.transpose());
}

Eigen::Matrix3d links_at_tip(const LinkEquations::Row& links, const MotionSample& sample) {
  const double sin_b = math::sin(sample.q[1]), sin_c = math::sin(sample.q[2]);
  Eigen::Vector3d inertia = links.head<3>();
  inertia[0] +=
      links[LinkEquations::kYawB] * sin_b * sin_b + links[LinkEquations::kYawC] * sin_c * sin_c;
  return sample.G.transpose() * inertia.asDiagonal() * sample.G;
}

}  // namespace thimble::bringup
