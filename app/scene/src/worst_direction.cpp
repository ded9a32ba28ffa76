#include "worst_direction.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdint>

#include "arm_table.h"
#include "thimble/scene/arm_simulation.h"

namespace thimble::scene {

double tip_step(const Eigen::Matrix3d& J_BT, const Eigen::Vector3d& joint_steps) {
  return (J_BT.cwiseAbs() * joint_steps).maxCoeff();
}

TipLimits tip_limits(const Eigen::Matrix3d& J_BT, const Eigen::Matrix3d& mass,
                     const Eigen::Matrix3d& damping, const Eigen::Vector3d& joint_steps) {
  const Eigen::FullPivLU<Eigen::Matrix3d> lu(J_BT);
  if (!lu.isInvertible()) return {};
  const Eigen::Matrix3d J_TB = lu.inverse();
  const auto smallest_eigenvalue = [](const Eigen::Matrix3d& symmetric) {
    return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(symmetric, Eigen::EigenvaluesOnly)
        .eigenvalues()
        .minCoeff();
  };
  return {.encoder_step = tip_step(J_BT, joint_steps),
          .damping = smallest_eigenvalue(J_TB.transpose() * damping * J_TB),
          .mass = smallest_eigenvalue(J_TB.transpose() * mass * J_TB)};
}

std::optional<Eigen::Matrix3d> jacobian_at(const ArmFile& arm, const Eigen::Vector3d& p_WT) {
  const auto q = joint_angles_at(arm, p_WT);
  if (!q) return {};
  if (arm.is<driver::VendorPoseArm>()) return Eigen::Matrix3d(Eigen::Matrix3d::Identity());
  const Eigen::Vector3d counts = arm.model.exact_counts(*q);
  driver::ArmReading reading;
  for (std::size_t k = 0; k < 3; ++k) {
    reading.counts[k] =
        static_cast<std::int32_t>(std::lround(counts[static_cast<Eigen::Index>(k)]));
  }
  return driver::make_arm(arm.protocol, arm.model, arm.wire.get())->pose(reading).J_BT;
}

std::vector<Eigen::Vector3d> points_of_workspace(const ArmFile& arm, int per_side) {
  std::vector<Eigen::Vector3d> points;
  const Eigen::Vector3d size = arm.workspace.max_W - arm.workspace.min_W;
  const double last = std::max(1, per_side - 1);
  // The workspace of an arm with one or two motors has no width across its line or plane.
  const auto count = [&](int axis) { return size[axis] > 0 ? per_side : 1; };
  for (int i = 0; i < count(0); ++i) {
    for (int j = 0; j < count(1); ++j) {
      for (int k = 0; k < count(2); ++k) {
        const Eigen::Vector3d p_W =
            arm.workspace.min_W + size.cwiseProduct(Eigen::Vector3d(i, j, k) / last);
        if (joint_angles_at(arm, p_W)) points.push_back(p_W);
      }
    }
  }
  return points;
}

TipLimits worst_over_workspace(const ArmFile& arm, int per_side) {
  TipLimits worst{
      .encoder_step = 0, .damping = arm.simulated.plant.viscous, .mass = arm.simulated.plant.mass};
  if (arm.simulated.firmware.ideal_encoders) return worst;
  const Eigen::Vector3d steps(arm.model.step(0), arm.model.step(1), arm.model.step(2));
  for (const Eigen::Vector3d& p_W : points_of_workspace(arm, per_side)) {
    if (const auto J_BT = jacobian_at(arm, p_W)) {
      worst.encoder_step = std::max(worst.encoder_step, tip_step(*J_BT, steps));
    }
  }
  return worst;
}

}  // namespace thimble::scene
