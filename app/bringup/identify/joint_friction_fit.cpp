#include "bringup/identify/joint_friction_fit.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bringup/identify/arm_constants.h"
#include "bringup/identify/delayed_tick.h"
#include "bringup/identify/weak_form/clustered_fit.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

// Information required to accept a friction, and max. share of the squared residual with it, if it
// is the cause of a bad fit [chosen as for saturation.cpp].
constexpr double kFrictionBetter = 10;
constexpr double kRubsLeft = 0.5;
// Ratio of the friction of a joint that sticks to that of the others [chosen: those of one arm that
// are 1/3 to 3 times the published values differ by nine times].
constexpr double kSticks = 10;
// Pieces in which no joint stands still, to measure friction [as in fit_motion], and to name a
// joint that mostly stands still as the cause [chosen].
constexpr Eigen::Index kPiecesMin = 300, kPiecesForCause = 50;
constexpr int kRubRounds = 4;  // of the search for friction and the reversals of the joints
// Errors due to the smoothing of signs beyond the statistics: of dry friction, as a share; of
// viscous friction, N m s/rad per N m of dry friction [chosen: so that intervals hold 95 % of the
// truths, identify_rubbing_test].
constexpr double kMethodDry = 0.004;
constexpr double kMethodBeside = 0.008;  // likewise, per dry friction of the tip
constexpr double kMethodViscous = 0.003;

using Vector8 = Eigen::Matrix<double, 8, 1>;

/// Columns in addition to those of a rigid arm without friction: dry and viscous of the tip, dry of
/// each joint, viscous of each joint.
enum Column { kTipDry = 0, kTipViscous = 1, kJointDry = 2, kJointViscous = 5, kColumns = 8 };

/// Frictions that are accepted or rejected together: those of a tip, or of joints.
struct Group {
  int first, count;
};
constexpr Group kOfTip{kTipDry, 2}, kOfJoints{kJointDry, 6}, kOfBoth{kTipDry, kColumns};

/// Rotation of the joints, tick by tick.
struct Turning {
  std::vector<Eigen::Vector3d> rate, sign;  // rad/s; the rate's mean sign over the tick
};

/// `dry`: dry friction of the joints, per mass at the tip, N m/kg.
Turning turning_of(const MotionEquations& equations, const Eigen::Vector3d& dry) {
  const auto& samples = equations.motion().samples;
  Turning turning;
  turning.rate.reserve(samples.size());
  for (std::size_t k = 0; k < samples.size(); ++k) {
    turning.rate.emplace_back(samples[k].G * equations.velocity(static_cast<int>(k)));
  }
  turning.sign.assign(samples.size(), Eigen::Vector3d::Zero());
  for (std::size_t k = 1; k + 1 < samples.size(); ++k) {
    for (int joint = 0; joint < 3; ++joint) {
      const double slowed = dry[joint] * samples[k].G.row(joint).squaredNorm();
      turning.sign[k][joint] = equations.sign_over(
          turning.rate[k - 1][joint], turning.rate[k][joint], turning.rate[k + 1][joint], slowed);
    }
  }
  return turning;
}

/// The equations of a motion in which no joint stands still, with separate columns for the friction
/// of tip and joints.
struct FrictionRows {
  Eigen::MatrixXd rows, further;
  Eigen::VectorXd rest;
  std::vector<int> clusters;
  double square = 0;  // of their residual of the fit
};

FrictionRows rows_of(const FittedMotion& motion, const Turning& turning) {
  const auto& equations = motion.equations.equations();
  std::vector<Eigen::Index> moving;
  for (std::size_t i = 0; i < equations.size(); ++i) {
    if (!motion.equations.stands(equations[i].middle, turning.rate)) {
      moving.push_back(static_cast<Eigen::Index>(i));
    }
  }
  const auto count = static_cast<Eigen::Index>(moving.size());
  FrictionRows found;
  found.rows = motion.residual.rows(moving, Eigen::all);
  found.rest = motion.residual.rest(moving);
  found.square = found.rest.squaredNorm();
  found.further.resize(count, kColumns);
  const auto& theta = motion.fit.theta;
  for (const auto& [own, further] : {std::pair(MassNormalisedFit::kCoulomb, kTipDry),
                                     std::pair(MassNormalisedFit::kViscous, kTipViscous)}) {
    found.further.col(further) = found.rows.col(own);
    found.rest += theta[own] * found.rows.col(own);
    found.rows.col(own).setZero();
  }
  using Six = Eigen::Matrix<double, 6, 1>;
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto number = static_cast<std::size_t>(moving[static_cast<std::size_t>(i)]);
    const int axis = equations[number].axis;
    found.clusters.push_back(motion.residual.clusters[number]);
    const Six pull = motion.equations.means<Six>(number, 1, [&](int tick) {
      const auto k = static_cast<std::size_t>(tick);
      const Eigen::Vector3d along = motion.motion().samples[k].G.col(axis);
      Six one;
      one << -along.cwiseProduct(turning.sign[k]), -along.cwiseProduct(turning.rate[k]);
      return one;
    });
    found.further.block<1, 6>(i, kJointDry) = pull.transpose();
  }
  return found;
}

/// Frictions by a fit, per mass; zero if not accepted.
struct FrictionFit {
  Vector8 factor = Vector8::Zero();
  Eigen::Matrix<double, 8, 8> covariance = Eigen::Matrix<double, 8, 8>::Zero();
  double square = 0;  // of its residual
};

FrictionFit fit_of(const FrictionRows& rows, const Group& group) {
  const FurtherColumns found = fit_further(
      rows.rows, rows.rest, rows.further.middleCols(group.first, group.count), rows.clusters);
  FrictionFit fit;
  fit.factor.segment(group.first, group.count) = found.factor;
  fit.covariance.block(group.first, group.first, group.count, group.count) = found.covariance;
  fit.square = found.left * rows.rest.squaredNorm();
  return fit;
}

/// Gain of the Bayesian information criterion by a group.
double better_with(const Group& group, const FrictionFit& fit, Eigen::Index rows) {
  const Eigen::VectorXd factor = fit.factor.segment(group.first, group.count);
  const Eigen::MatrixXd covariance =
      fit.covariance.block(group.first, group.first, group.count, group.count);
  return factor.dot(covariance.ldlt().solve(factor)) -
         group.count * math::log(static_cast<double>(rows));
}

/// Accepted groups.
struct AcceptedGroups {
  bool joints = false, tip = true;
};

/// Removes unnecessary groups: of tip and joints, the one with less information first.
FrictionFit select_groups(const FrictionRows& rows, AcceptedGroups& accepted) {
  const FrictionFit both = fit_of(rows, kOfBoth);
  const double joints = better_with(kOfJoints, both, rows.rest.size());
  const double tip = better_with(kOfTip, both, rows.rest.size());
  accepted = {.joints = joints > kFrictionBetter, .tip = true};
  if (tip > kFrictionBetter || joints < tip) return both;
  const FrictionFit alone = fit_of(rows, kOfJoints);
  accepted = {.joints = better_with(kOfJoints, alone, rows.rest.size()) > kFrictionBetter,
              .tip = false};
  return alone;
}

/// Stores the result relative to gains per mass, in the pose of `G`.
void put(JointFrictionFit& found, const FrictionFit& fit, const Eigen::Vector3d& gain,
         const Eigen::Matrix3d& G) {
  const auto of = [&](int column, double per) {
    return Estimate{fit.factor[column] / per,
                    kNormal95 * std::sqrt(fit.covariance(column, column)) / per};
  };
  found.tip_coulomb = of(kTipDry, 1);
  found.tip_viscous = of(kTipViscous, 1);
  // Frictions that reverse at about the same time are distinguished only by small differences.
  double dry = std::abs(found.tip_coulomb.value);  // at the tip
  for (int joint = 0; joint < 3; ++joint) {
    const auto k = static_cast<std::size_t>(joint);
    found.coulomb[k] = of(kJointDry + joint, gain[joint]);
    found.viscous[k] = of(kJointViscous + joint, gain[joint]);
    const double own = std::abs(found.coulomb[k].value);
    const double of_tip =
        std::abs(found.tip_coulomb.value) / (G.row(joint).norm() * gain[joint]);  // N m
    widen(found.coulomb[k], kMethodDry * own + kMethodBeside * of_tip);
    widen(found.viscous[k], kMethodViscous * (own + of_tip));
    dry = std::max(dry, std::abs(fit.factor[kJointDry + joint]) * G.row(joint).norm());
  }
  widen(found.tip_coulomb, kMethodDry * dry);
}

/// Computes the detection limits of each joint in addition to the tip's friction.
void put_bounds(JointFrictionFit& found, const FrictionRows& rows, const Eigen::Vector3d& gain) {
  const FrictionFit fit = fit_of(rows, kOfBoth);
  const double seen =
      kNormal95 + std::sqrt(kFrictionBetter +
                            kOfJoints.count * math::log(static_cast<double>(rows.rest.size())));
  for (int joint = 0; joint < 3; ++joint) {
    const auto k = static_cast<std::size_t>(joint);
    const auto of = [&](int column) {
      return seen * std::sqrt(fit.covariance(column, column)) / gain[joint];
    };
    found.coulomb_below[k] = of(kJointDry + joint);
    found.viscous_below[k] = of(kJointViscous + joint);
  }
}

Eigen::Vector3d gains(const MassNormalisedFit& fit) {
  return fit.theta.segment<3>(MassNormalisedFit::kGain);
}

}  // namespace

int JointFrictionFit::strongest_joint() const {
  const auto clear = [this](int i) {
    const Estimate& one = coulomb[static_cast<std::size_t>(i)];
    return one.value / (one.plus_minus + 1e-12);
  };
  int best = 0;
  for (int i = 1; i < 3; ++i) best = clear(i) > clear(best) ? i : best;
  return best;
}

int JointFrictionFit::stuck(double tip, const Eigen::Vector3d& levers) const {
  if (!seen) return -1;
  int joint = 0;
  for (int i = 1; i < 3; ++i) {
    const auto k = static_cast<std::size_t>(i);
    joint = coulomb[k].value > coulomb[static_cast<std::size_t>(joint)].value ? i : joint;
  }
  const double own = coulomb[static_cast<std::size_t>(joint)].value;
  if (!(own > tip * levers[joint])) return -1;
  for (int i = 0; i < 3; ++i) {
    if (i != joint && own < kSticks * coulomb[static_cast<std::size_t>(i)].value) return -1;
  }
  return joint;
}

driver::Result<JointFrictionFit> fit_joint_friction(const ArmMotion& motion,
                                                    const MassNormalisedFit& fit) {
  JointFrictionFit none;
  // The effect of a motor with the wrong sign is not friction.
  if ((gains(fit).array() <= 0).any()) return none;
  const FittedMotion first(motion, fit);
  AcceptedGroups accepted;
  const FrictionRows rows = rows_of(first, turning_of(first.equations, {0, 0, 0}));
  if (rows.rest.size() < kPiecesMin) return none;
  FrictionFit seen = select_groups(rows, accepted);
  none.searched = true;
  put_bounds(none, rows, gains(fit));
  if (!accepted.joints) return none;
  JointFrictionFit found = none;
  found.delay = fit.delay.value;
  found.seen = true;
  const double square = first.residual.rest.squaredNorm();
  // The friction found changes the joint motion at reversals, and so the result itself.
  MassNormalisedFit last = fit;
  for (int round = 0; round < kRubRounds; ++round) {
    put(found, seen, gains(last), motion.samples.back().G);
    const ArmMotion cleaned = without_joint_friction(motion, found, last);
    const auto again = fit_motion(cleaned, false);
    if (!again) return again.error();
    last = *again;
    if ((gains(last).array() <= 0).any()) return none;
    found.delay = last.delay.value;
    const FittedMotion left(cleaned, last);
    found.left = left.residual.rest.squaredNorm() / square;
    // All of the friction once more, with the known reversals of the joints.
    FrictionRows all = rows_of(left, turning_of(left.equations, seen.factor.segment<3>(kJointDry)));
    for (int joint = 0; joint < 3; ++joint) {
      const auto k = static_cast<std::size_t>(joint);
      all.rest +=
          gains(last)[joint] * (found.coulomb[k].value * all.further.col(kJointDry + joint) +
                                found.viscous[k].value * all.further.col(kJointViscous + joint));
    }
    seen = select_groups(all, accepted);
    if (!accepted.joints) return none;
  }
  found.tip_rubs = accepted.tip;
  put(found, seen, gains(last), motion.samples.back().G);
  // An effect that drives a joint is not friction, although it looks similar.
  const bool pushes =
      std::any_of(found.coulomb.begin(), found.coulomb.end(),
                  [](const Estimate& one) { return one.value + one.plus_minus < 0; });
  return pushes ? none : found;
}

ArmMotion without_joint_friction(const ArmMotion& motion, const JointFrictionFit& rubbing,
                                 const MassNormalisedFit& fit) {
  ArmMotion cleaned = motion;
  if (!rubbing.seen) return cleaned;
  Eigen::Vector3d dry, viscous;
  for (int joint = 0; joint < 3; ++joint) {
    dry[joint] = rubbing.coulomb[static_cast<std::size_t>(joint)].value;
    viscous[joint] = rubbing.viscous[static_cast<std::size_t>(joint)].value;
  }
  const MotionEquations equations(motion, false);
  const Turning turning = turning_of(equations, gains(fit).cwiseProduct(dry));
  const auto torque = [&](std::size_t k) -> Eigen::Vector3d {
    return dry.cwiseProduct(turning.sign[k]) + viscous.cwiseProduct(turning.rate[k]);
  };
  const DelayedTick acting(rubbing.delay, motion.dt);
  for (std::size_t k = 0; k + acting.whole + 1 < cleaned.samples.size(); ++k) {
    cleaned.samples[k].tau -= acting.then(k, torque);
  }
  return cleaned;
}

JointFrictionFit joint_friction_left(const FittedMotion& motion) {
  JointFrictionFit found;
  const FrictionRows rows = rows_of(motion, turning_of(motion.equations, {0, 0, 0}));
  if (rows.rest.size() < kPiecesForCause) return found;
  const FrictionFit fit = fit_of(rows, kOfBoth);
  const double better = better_with(kOfJoints, fit, rows.rest.size());
  found.searched = true;
  put(found, fit, gains(motion.fit), motion.motion().samples.back().G);
  found.seen = better > kFrictionBetter && fit.square < kRubsLeft * rows.square;
  return found;
}

}  // namespace thimble::bringup
