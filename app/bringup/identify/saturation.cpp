#include "bringup/identify/saturation.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "bringup/identify/weak_form/clustered_fit.h"

namespace thimble::app {
namespace {

// Information by which it must be better before it is believed, and how much of the torque beyond
// must be missing [chosen: none of 200 hidden arms without is told to have one].
constexpr double kBetter = 10;
constexpr double kMissingLeast = 0.3;
// Half-width of the interval of the share that is missing, up to which a search is one.
constexpr double kSearched = 0.3;
// Share of the residual's square that may be left with all of them: what else makes a fit bad
// (cogging, a hand) looks a little like an amplifier that saturates, and is not explained by one.
constexpr double kLeftMost = 0.3;
constexpr int kRounds = 4;  // of Newton's search for the torque

/// Torques of all ticks of one joint, the others' zero.
template <class Of>
std::vector<Eigen::Vector3d> torques_of(const ArmMotion& motion, int joint, const Of& of) {
  std::vector<Eigen::Vector3d> all(motion.samples.size(), Eigen::Vector3d::Zero());
  for (std::size_t i = 0; i < all.size(); ++i) all[i][joint] = of(motion.samples[i].tau[joint]);
  return all;
}

/// What torques of a joint do to all equations, per mass.
Eigen::VectorXd pushed(const FittedMotion& motion, int joint,
                       const std::vector<Eigen::Vector3d>& torques) {
  Eigen::VectorXd column(motion.residual.rows.rows());
  for (Eigen::Index i = 0; i < column.size(); ++i) {
    column[i] = motion.equations.pushed(static_cast<std::size_t>(i), motion.fit.delay.value,
                                        torques)[joint];
  }
  return column;
}

double beyond(double torque, double most) {
  return torque - std::clamp(torque, -most, most);
}

/// Of a motor that was found to give no more than about `most`: by how much that is off.
void refine(const FittedMotion& motion, int joint, double& most, double& error) {
  const double first = motion.fit.theta[PerMass::kGain + joint];
  double gain = first;
  for (int round = 0; round < kRounds; ++round) {
    // What is missing is taken off, and what a little more would give is looked for.
    const Eigen::VectorXd missing =
        pushed(motion, joint,
               torques_of(motion.motion(), joint, [&](double tau) { return beyond(tau, most); }));
    const Eigen::MatrixXd edge =
        pushed(motion, joint, torques_of(motion.motion(), joint, [&](double tau) {
                 return std::abs(tau) > most ? std::copysign(1.0, tau) : 0.0;
               }));
    const FurtherColumns found =
        fit_further(motion.residual.rows, motion.residual.rest + gain * missing, gain * edge,
                    motion.residual.clusters);
    gain = first + found.change[PerMass::kGain + joint];
    most += std::clamp(found.factor[0], -0.3 * most, 0.3 * most);
    error = kNormal95 * std::sqrt(found.covariance(0, 0));
  }
}

/// Returns whether the amplifiers that seem to saturate are what makes the fit bad.
bool explain(const FittedMotion& motion, const std::array<Saturation, 3>& all) {
  std::vector<Eigen::VectorXd> columns;
  for (int joint = 0; joint < 3; ++joint) {
    const Saturation& one = all[static_cast<std::size_t>(joint)];
    if (!one.seen) continue;
    columns.push_back(pushed(motion, joint, torques_of(motion.motion(), joint, [&](double tau) {
                               return -beyond(tau, one.most.value);
                             })));
  }
  if (columns.empty()) return false;
  Eigen::MatrixXd together(columns.front().size(), static_cast<Eigen::Index>(columns.size()));
  for (std::size_t i = 0; i < columns.size(); ++i) {
    together.col(static_cast<Eigen::Index>(i)) = columns[i];
  }
  return fit_further(motion.residual.rows, motion.residual.rest, together, motion.residual.clusters)
             .left < kLeftMost;
}

}  // namespace

std::array<Saturation, 3> saturations(const FittedMotion& motion) {
  std::array<Saturation, 3> all;
  for (int joint = 0; joint < 3; ++joint) {
    Saturation& one = all[static_cast<std::size_t>(joint)];
    std::vector<double> asked;
    for (const MotionSample& sample : motion.motion().samples) {
      asked.push_back(std::abs(sample.tau[joint]));
    }
    std::sort(asked.begin(), asked.end());
    one.asked = asked.back();
    const double gain = motion.fit.theta[PerMass::kGain + joint];
    double best = 0;
    for (const double share : {0.5, 0.7, 0.85, 0.95, 0.98}) {
      const double most =
          asked[static_cast<std::size_t>(share * static_cast<double>(asked.size() - 1))];
      const Eigen::MatrixXd column = pushed(
          motion, joint,
          torques_of(motion.motion(), joint, [&](double tau) { return -beyond(tau, most); }));
      const FurtherColumns found =
          fit_further(motion.residual.rows, motion.residual.rest, column, motion.residual.clusters);
      const double missing = found.factor[0] / gain;
      const double error = kNormal95 * std::sqrt(found.covariance(0, 0)) / gain;
      one.searched = one.searched || error < kSearched;
      if (found.better < std::max(best, kBetter) || missing < kMissingLeast) continue;
      best = found.better;
      one.seen = true;
      one.most.value = most;
    }
    if (one.seen) refine(motion, joint, one.most.value, one.most.plus_minus);
  }
  if (!explain(motion, all)) {
    for (Saturation& one : all) one.seen = false;
  }
  return all;
}

}  // namespace thimble::app
