#include "bringup/identify/joint_friction.h"

#include <Eigen/LU>
#include <cmath>

namespace thimble::bringup {

std::array<std::vector<FrictionPoint>, 3> joint_friction(const FittedMotion& motion,
                                                         const Identified& found) {
  const double mass = found.moved_mass().value;
  std::array<std::vector<FrictionPoint>, 3> points;
  const auto& equations = motion.equations.equations();
  // One equation for each axis along which the tip moves, so as many as motors.
  const int motors = found.moved.motors;
  const auto last = static_cast<std::size_t>(motors - 1);
  for (std::size_t i = 0; i + last < equations.size(); ++i) {
    const int middle = equations[i].middle;
    if (equations[i].axis != 0 || equations[i + last].middle != middle) continue;
    if (equations[i + last].axis != motors - 1) continue;
    Eigen::Vector3d seen(0, 0, 0), fitted(0, 0, 0);  // N at the tip
    for (int axis = 0; axis < motors; ++axis) {
      const auto& equation = equations[i + static_cast<std::size_t>(axis)];
      const auto row = static_cast<Eigen::Index>(i) + axis;
      const double friction = motion.residual.rows(row, MassNormalisedFit::kViscous) *
                                  motion.fit.theta[MassNormalisedFit::kViscous] +
                              motion.residual.rows(row, MassNormalisedFit::kCoulomb) *
                                  motion.fit.theta[MassNormalisedFit::kCoulomb];
      fitted[equation.axis] = -mass * friction;
      seen[equation.axis] = -mass * (friction + motion.residual.rest[row]);
    }
    const Eigen::Matrix3d& G = motion.motion().samples[static_cast<std::size_t>(middle)].G;
    const Eigen::Matrix3d J_T = G.inverse().transpose();
    const Eigen::Vector3d speed = G * motion.equations.velocity(middle);
    const Eigen::Vector3d of_seen = J_T * seen, of_fitted = J_T * fitted;
    for (int joint = 0; joint < motors; ++joint) {
      const auto k = static_cast<std::size_t>(joint);
      const double rubs = found.rubbing.seen
                              ? std::copysign(found.joint_coulomb(k).value, speed[joint]) +
                                    found.joint_viscous(k).value * speed[joint]
                              : 0;
      points[k].push_back({speed[joint], of_seen[joint] + rubs, of_fitted[joint] + rubs});
    }
  }
  return points;
}

}  // namespace thimble::bringup
