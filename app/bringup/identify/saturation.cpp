#include "bringup/identify/saturation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bringup/identify/weak_form/clustered_fit.h"
#include "math/elementary.h"

namespace thimble::bringup {
namespace {

// Information required for acceptance, and min. missing share of the torque beyond the limit
// [chosen: no hidden arm of identify_test is reported to saturate].
constexpr double kBetter = 10;
constexpr double kMissingMin = 0.3;
// Max. half-width of the interval of the missing share for a valid search.
constexpr double kSearched = 0.3;
// Max. share of the squared residual with all of them. Other causes of a bad fit (cogging, a hand)
// look similar to a saturated amplifier, which does not explain them.
constexpr double kLeftMax = 0.3;
// Error of a torque found, due to held torques and the friction's signs, as a standard deviation
// [chosen so that intervals hold 95 % of the truths, identify_further_test].
constexpr double kMethod = 0.02;
constexpr int kRounds = 6;  // of Newton's search for the torque

/// Torques of all ticks of one joint, the others' zero.
template <class Of>
std::vector<Eigen::Vector3d> torques_of(const ArmMotion& motion, int joint, const Of& of) {
  std::vector<Eigen::Vector3d> all(motion.samples.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < all.size(); ++i) all[i][joint] = of(motion.samples[i].tau[joint]);
  return all;
}

/// Effect of torques of a joint on all equations, per mass.
Eigen::VectorXd pushed(const FittedMotion& motion, int joint,
                       const std::vector<Eigen::Vector3d>& torques) {
  Eigen::VectorXd column(motion.residual.rows.rows());
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    column[i] = motion.equations.pushed(static_cast<std::size_t>(i), motion.fit.delay.value,
                                        torques)[joint];
  }
  return column;
}

double beyond(double torque, double max_torque) {
  return torque - std::clamp(torque, -max_torque, max_torque);
}

/// Joints whose motors seem to saturate.
std::vector<int> seen_of(const std::array<Saturation, 3>& all) {
  std::vector<int> joints;
  for (int joint = 0; joint < 3; ++joint) {
    if (all[static_cast<std::size_t>(joint)].seen) joints.push_back(joint);
  }
  return joints;
}

/// For motors that give at most about `max_torque`: finds all of these limits together, by Newton's
/// rule. The missing torque is removed, and the effect of a slightly higher limit is fitted.
void refine(const FittedMotion& motion, std::array<Saturation, 3>& all) {
  const std::vector<int> joints = seen_of(all);
  Eigen::Vector3d gain = motion.fit.theta.segment<3>(MassNormalisedFit::kGain);
  for (int round = 0; round < kRounds && !joints.empty(); ++round) {
    Eigen::VectorXd rest = motion.residual.rest;
    Eigen::MatrixXd edges(rest.size(), static_cast<Eigen::Index>(joints.size()));
    for (std::size_t i = 0; i < joints.size(); ++i) {
      const int joint = joints[i];
      const double max_torque = all[static_cast<std::size_t>(joint)].max_torque.value;
      rest += gain[joint] * pushed(motion, joint,
                                   torques_of(motion.motion(), joint,
                                              [&](double tau) { return beyond(tau, max_torque); }));
      edges.col(static_cast<Eigen::Index>(i)) =
          gain[joint] * pushed(motion, joint, torques_of(motion.motion(), joint, [&](double tau) {
                                 return std::abs(tau) > max_torque ? std::copysign(1.0, tau) : 0.0;
                               }));
    }
    const FurtherColumns found =
        fit_further(motion.residual.rows, rest, edges, motion.residual.clusters);
    gain = motion.fit.theta.segment<3>(MassNormalisedFit::kGain) +
           found.change.segment<3>(MassNormalisedFit::kGain);
    for (std::size_t i = 0; i < joints.size(); ++i) {
      Estimate& max_torque = all[static_cast<std::size_t>(joints[i])].max_torque;
      const auto k = static_cast<Eigen::Index>(i);
      max_torque.value +=
          std::clamp(found.factor[k], -0.3 * max_torque.value, 0.3 * max_torque.value);
      max_torque.plus_minus =
          kNormal95 * math::hypot(std::sqrt(found.covariance(k, k)), kMethod * max_torque.value);
    }
  }
}

/// Returns whether the amplifiers that seem to saturate are the cause of the bad fit.
bool explain(const FittedMotion& motion, const std::array<Saturation, 3>& all) {
  std::vector<Eigen::VectorXd> columns;
  for (const int joint : seen_of(all)) {
    const Saturation& one = all[static_cast<std::size_t>(joint)];
    columns.push_back(pushed(motion, joint, torques_of(motion.motion(), joint, [&](double tau) {
                               return -beyond(tau, one.max_torque.value);
                             })));
  }
  if (columns.empty()) return false;
  Eigen::MatrixXd together(columns.front().size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    together.col(static_cast<Eigen::Index>(i)) = columns[i];
  }
  return fit_further(motion.residual.rows, motion.residual.rest, together, motion.residual.clusters)
             .left < kLeftMax;
}

}  // namespace

std::array<Saturation, 3> saturations(const FittedMotion& motion) {
  std::array<Saturation, 3> all;
  for (int joint = 0; joint < motion.motion().motors; ++joint) {
    Saturation& one = all[static_cast<std::size_t>(joint)];
    std::vector<double> asked;
    for (const MotionSample& sample : motion.motion().samples) {
      asked.push_back(std::abs(sample.tau[joint]));
    }
    std::sort(asked.begin(), asked.end());
    one.asked = asked.back();
    const double gain = motion.fit.theta[MassNormalisedFit::kGain + joint];
    double best = 0;
    for (const double share : {0.5, 0.7, 0.85, 0.95, 0.98}) {
      const double max_torque =
          asked[static_cast<std::size_t>(share * static_cast<double>(asked.size() - 1))];
      const Eigen::MatrixXd column = pushed(
          motion, joint,
          torques_of(motion.motion(), joint, [&](double tau) { return -beyond(tau, max_torque); }));
      const FurtherColumns found =
          fit_further(motion.residual.rows, motion.residual.rest, column, motion.residual.clusters);
      const double missing = found.factor[0] / gain;
      const double error = kNormal95 * std::sqrt(found.covariance(0, 0)) / gain;
      one.searched = one.searched || error < kSearched;
      if (found.better < std::max(best, kBetter) || missing < kMissingMin) continue;
      best = found.better;
      one.seen = true;
      one.max_torque.value = max_torque;
    }
  }
  refine(motion, all);
  if (!explain(motion, all)) {
    for (Saturation& one : all) one.seen = false;
  }
  return all;
}

}  // namespace thimble::bringup
