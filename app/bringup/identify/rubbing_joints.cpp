#include "bringup/identify/rubbing_joints.h"

#include <cmath>

#include "bringup/identify/weak_form/clustered_fit.h"

namespace thimble::app {
namespace {

// Information by which it must be better before it is believed, and share of the residual's square
// that may be left with it, where it is what makes the fit bad [chosen as for saturation.cpp].
constexpr double kRubsBetter = 10;
constexpr double kRubsLeft = 0.5;

}  // namespace

int RubbingJoints::most() const {
  const auto clear = [this](int i) {
    const Estimate& one = coulomb[static_cast<std::size_t>(i)];
    return one.value / (one.plus_minus + 1e-12);
  };
  int best = 0;
  for (int i = 1; i < 3; ++i) best = clear(i) > clear(best) ? i : best;
  return best;
}

RubbingJoints rubbing_joints(const FittedMotion& motion, double mass) {
  const Eigen::MatrixXd& rows = motion.residual.rows;
  Eigen::MatrixXd columns(rows.rows(), 3);
  for (Eigen::Index i = 0; i < rows.rows(); ++i) {
    for (int joint = 0; joint < 3; ++joint) {
      const auto pull = [&](int tick, int axis) {
        const Eigen::Matrix3d& G = motion.motion().samples[static_cast<std::size_t>(tick)].G;
        const double turning = G.row(joint).dot(motion.equations.velocity(tick));
        return turning > 0 ? -G(joint, axis) : turning < 0 ? G(joint, axis) : 0.0;
      };
      columns(i, joint) = motion.equations.mean(static_cast<std::size_t>(i), pull);
    }
  }
  const FurtherColumns found =
      fit_further(rows, motion.residual.rest, columns, motion.residual.clusters);
  RubbingJoints rubbing;
  for (int joint = 0; joint < 3; ++joint) {
    rubbing.coulomb[static_cast<std::size_t>(joint)] = {
        mass * found.factor[joint], mass * kNormal95 * std::sqrt(found.covariance(joint, joint))};
  }
  rubbing.seen = found.better > kRubsBetter && found.left < kRubsLeft;
  return rubbing;
}

}  // namespace thimble::app
