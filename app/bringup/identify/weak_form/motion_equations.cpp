#include "bringup/identify/weak_form/motion_equations.h"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "bringup/identify/link_inertia/link_equations.h"

namespace thimble::bringup {
namespace {

constexpr int kHop = 15;         // ticks between bumps
constexpr int kSmooth = 10;      // ticks to either side, for the sign of a velocity
constexpr double kSlow = 0.003;  // m/s, below which the sign of a velocity is unknown
constexpr int kSlowMax = 3;      // ticks at such speed of an axis that reverses and does not stick

}  // namespace

MotionEquations::MotionEquations(const ArmMotion& motion, bool with_inertia)
    : motion_(motion), with_inertia_(with_inertia), bump_(motion.dt) {
  for (const double value : bump_.value) area_ += value;
  if (!motion.links.isZero(0) && !motion.samples.empty()) {
    masses_ += links_at_tip(motion.links, motion.samples[motion.samples.size() / 2]);
  }
  find_velocities();
  gather();
  find_signs(0);
}

driver::Error MotionEquations::torn_error(const ArmMotion& motion) {
  std::size_t missing = 0;
  for (const MotionSample& sample : motion.samples) missing += sample.fresh ? 0 : 1;
  if (2 * motion.jumped > missing) {
    return driver::Error{fmt::format(
        "The motion cannot be used: in {:.0f} % of the ticks a joint jumped farther than the "
        "driver accepts, and the report was dropped. A motor oscillates on its cable under the "
        "force that holds the tip, or its encoder loses counts.",
        100 * static_cast<double>(motion.jumped) / static_cast<double>(motion.samples.size()))};
  }
  return driver::Error{
      "The motion cannot be used: too many ticks had no new report. Run `thimble doctor` to find "
      "what delays reports."};
}

void MotionEquations::find_velocities() {
  const TurnSmoothing<kSmooth> smooth(motion_.dt);
  mean_distance_ = smooth.mean_distance;
  velocity_.assign(motion_.samples.size(), Eigen::Vector3d::Zero());
  const int end = static_cast<int>(motion_.samples.size()) - kSmooth;
  for (int k = kSmooth; k < end; ++k) {
    Eigen::Vector3d sum(0, 0, 0);
    for (int j = -kSmooth; j <= kSmooth; ++j) {
      sum -= smooth.slope[static_cast<std::size_t>(j + kSmooth)] * at(k + j).p_BT;
    }
    velocity_[static_cast<std::size_t>(k)] = sum;
  }
}

void MotionEquations::find_signs(double coulomb) {
  // When one axis reverses, only its own friction changes.
  find_signs(Eigen::Vector3d(std::max(0.0, coulomb) * masses_.inverse().diagonal()));
}

void MotionEquations::find_signs(const Eigen::Vector3d& slowed) {
  sign_.assign(velocity_.size(), Eigen::Vector3d::Zero());
  for (std::size_t k = 1; k + 1 < velocity_.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis) {
      sign_[k][axis] = sign_over(velocity_[k - 1][axis], velocity_[k][axis], velocity_[k + 1][axis],
                                 slowed[axis]);
    }
  }
  sum_frictions();
}

double MotionEquations::sign_over(double before, double here, double after, double slowed) const {
  const double rise = after - before;
  const double v = here + std::copysign(slowed * mean_distance_, rise);
  const double half_tick = 0.25 * std::abs(rise);
  return std::abs(v) < half_tick ? v / half_tick : v > 0 ? 1 : v < 0 ? -1 : 0;
}

bool MotionEquations::stands(int middle, const std::vector<Eigen::Vector3d>& rate) const {
  for (int joint = 0; joint < 3; ++joint) {
    int slow = 0;
    for (int j = -kHalf; j <= kHalf; ++j) {
      const double min_rate = kSlow * at(middle + j).G.row(joint).norm();
      const double turning = rate[static_cast<std::size_t>(middle + j)][joint];
      slow = std::abs(turning) < min_rate ? slow + 1 : 0;
      if (slow > kSlowMax) return true;
    }
  }
  return false;
}

void MotionEquations::gather() {
  const int first = kHalf + static_cast<int>(kDelayMax / motion_.dt) + 2;
  const int end = static_cast<int>(motion_.samples.size()) - kHalf - kSmooth;
  for (int middle = first; middle < end; middle += kHop) {
    bool whole = true;
    for (int j = -kHalf; j <= kHalf; ++j) whole = whole && at(middle + j).fresh;
    if (!whole) {
      ++torn_;
      continue;
    }
    ++whole_;
    for (int axis = 0; axis < 3; ++axis) {
      int slow = 0, slowest = 0;
      double left = 0;
      for (int j = -kHalf; j <= kHalf; ++j) {
        const auto i = static_cast<std::size_t>(j + kHalf);
        const double v = velocity_[static_cast<std::size_t>(middle + j)][axis];
        slow = std::abs(v) < kSlow ? slow + 1 : 0;
        slowest = std::max(slowest, slow);
        left += bump_.curvature[i] * (at(middle + j).p_BT[axis] - at(middle).p_BT[axis]);
      }
      if (slowest > kSlowMax) {
        ++left_out_;
        continue;
      }
      equations_.push_back({.middle = middle, .axis = axis, .left = left / area_});
    }
  }
  if (motion_.links.isZero(0)) return;
  const LinkEquations links(motion_);
  for (Equation& equation : equations_) equation.left += links.row(equation).dot(motion_.links);
}

void MotionEquations::sum_frictions() {
  // Dry friction depends on the times of reversal; nothing here depends on the delay.
  for (Equation& equation : equations_) {
    const int axis = equation.axis, middle = equation.middle;
    equation.viscous = equation.coulomb = equation.stiffness = 0;
    for (int j = -kHalf; j < kHalf; ++j) {
      const auto i = static_cast<std::size_t>(j + kHalf);
      const double p = at(middle + j).p_BT[axis];
      equation.viscous += bump_.slope[i] * (p - at(middle).p_BT[axis]);
      equation.coulomb -= bump_.value[i] * sign_[static_cast<std::size_t>(middle + j)][axis];
      equation.stiffness -= bump_.value[i] * p;
    }
  }
}

template <class TorqueAt>
MotionEquations::Pushed MotionEquations::sum_of(std::size_t number, int late,
                                                const TorqueAt& torque_at) const {
  Pushed sums;
  const int axis = equations_[number].axis, middle = equations_[number].middle;
  for (int j = -kHalf; j < kHalf; ++j) {
    const auto i = static_cast<std::size_t>(j + kHalf);
    const MotionSample &here = at(middle + j), &next = at(middle + j + 1);
    const Eigen::Vector3d& tau = torque_at(middle + j - late);
    const Eigen::Vector3d from = bump_.value[i] * here.G.col(axis);
    const Eigen::Vector3d rise = bump_.value[i + 1] * next.G.col(axis) - from;
    sums.from += tau.cwiseProduct(from);
    sums.rise += tau.cwiseProduct(rise);
    // The terms of accelerations change little within a tick.
    if (with_inertia_) sums.inert -= at(middle + j - late).ddq.cwiseProduct(from + 0.5 * rise);
  }
  sums.summed = true;
  return sums;
}

const MotionEquations::Pushed& MotionEquations::pushed_late(std::size_t number, int late) const {
  // A line search uses the same ticks repeatedly, so each sum is computed once.
  auto& all = pushed_[static_cast<std::size_t>(late)];
  if (all.empty()) all.resize(equations_.size());
  Pushed& sums = all[number];
  if (!sums.summed) {
    sums =
        sum_of(number, late, [this](int tick) -> const Eigen::Vector3d& { return at(tick).tau; });
  }
  return sums;
}

double MotionEquations::part_of(double delay, int& whole) const {
  const double ticks = delay / motion_.dt;
  whole = static_cast<int>(std::floor(ticks));
  return ticks - whole;
}

Eigen::Vector3d MotionEquations::joined(const Pushed& older, const Pushed& newer, double part) {
  return part * (older.from + 0.5 * part * older.rise) +
         (1 - part) * (newer.from + 0.5 * (1 + part) * newer.rise);
}

MotionEquations::Row MotionEquations::row(std::size_t number, double delay) const {
  Row row = Row::Zero();
  const Equation& equation = equations_[number];
  int whole = 0;
  const double part = part_of(delay, whole);
  const Pushed &older = pushed_late(number, whole + 1), &newer = pushed_late(number, whole);
  row.segment<3>(MassNormalisedFit::kGain) = joined(older, newer, part);
  row.segment<3>(MassNormalisedFit::kInertia) = part * older.inert + (1 - part) * newer.inert;
  row[MassNormalisedFit::kViscous] = equation.viscous;
  row[MassNormalisedFit::kCoulomb] = equation.coulomb;
  row[MassNormalisedFit::kStiffness] = equation.stiffness;
  row /= area_;
  row[MassNormalisedFit::kWeight + equation.axis] = 1;
  return row;
}

Eigen::Vector3d MotionEquations::pushed(std::size_t number, double delay,
                                        const std::vector<Eigen::Vector3d>& torques) const {
  int whole = 0;
  const double part = part_of(delay, whole);
  const auto torque_at = [&](int tick) -> const Eigen::Vector3d& {
    return torques[static_cast<std::size_t>(tick)];
  };
  return joined(sum_of(number, whole + 1, torque_at), sum_of(number, whole, torque_at), part) /
         area_;
}

double MotionEquations::noise() const {
  double curvature = 0;
  for (const double value : bump_.curvature) curvature += value * value;
  const Eigen::Matrix3d J = at(equations_.front().middle).G.inverse();
  const double at_tip = (masses_ * J * motion_.step.asDiagonal()).squaredNorm() / motion_.motors;
  return std::sqrt(curvature * at_tip / 12) / area_;
}

}  // namespace thimble::bringup
