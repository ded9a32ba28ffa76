#include "worst_direction.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>

#include "stability/stability_laws.h"
#include "stability/tuning.h"
#include "support/dense_algebra.h"
#include "support/hard_case.h"
#include "support/random.h"
#include "support/scratch.h"
#include "thimble/scene/arm_simulation.h"
#include "thimble/scene/scene_file.h"

// The rule for three dimensions [PHYSICS 9] compared with simulation on the real kinematics, at
// poses over the whole workspace.

namespace thimble::stability {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

scene::ArmFile shipped(const std::string& name) {
  auto arm = scene::load_arm(std::string(THIMBLE_SOURCE_DIR) + "/app/arms/" + name + ".yaml");
  if (!arm) throw std::runtime_error(arm.error().message);
  return *arm;
}

Vector3d joint_steps(const scene::ArmFile& arm) {
  return {arm.model.step(0), arm.model.step(1), arm.model.step(2)};
}

/// Returns the largest 2 c / K, m, at which an adversary gains energy who steps from `p_W` along
/// `n_W` across one edge of each encoder and back. It is the step size to use in the law. The arm
/// reads joint angles rounded down, and the wall responds at the measured tip.
double adversary_step(const scene::ArmFile& arm, const Vector3d& p_W, const Vector3d& n_W) {
  const auto q = scene::joint_angles_at(arm, p_W);
  const auto J = scene::jacobian_at(arm, p_W);
  if (!q || !J) return 0;
  // A short step along n turns each joint in one direction; each encoder is just before its edge in
  // that direction.
  const Vector3d turned = J->inverse() * (arm.R_WB.transpose() * n_W);
  Vector3d q_read = *q, q_next = *q;
  for (int k = 0; k < 3; ++k) {
    q_next[k] += (turned[k] > 0 ? 1 : -1) * arm.model.step(static_cast<std::size_t>(k));
  }
  const auto& geometry = std::get<driver::SerialArm>(arm.model.geometry);
  const Vector3d jump_W = arm.R_WB * (geometry.forward(q_next) - geometry.forward(q_read));
  // The gain is K (jump . n) d, the loss 2 c d (|n_x| + |n_y| + |n_z|) in the base's axes.
  return jump_W.dot(n_W) / (arm.R_WB.transpose() * n_W).cwiseAbs().sum();
}

TEST(HardCaseEncoderAdversary, RuleBoundsStepsIn3D) {
  for (const char* const name : {"vintage_phantom", "woodenhaptics"}) {
    const scene::ArmFile arm = shipped(name);
    support::Random random(9);
    double worst = 0, worst_column = 0, tightest = 0;
    int poses = 0;
    for (const Vector3d& p_W : scene::points_of_workspace(arm, 5)) {
      const auto J = scene::jacobian_at(arm, p_W);
      ASSERT_TRUE(J);
      const double rule = scene::tip_step(*J, joint_steps(arm));
      const double column =
          (J->cwiseAbs() * joint_steps(arm).asDiagonal()).colwise().sum().maxCoeff();
      double longest = 0;
      for (int i = 0; i < 200; ++i) {
        const Vector3d n = i < 3 ? Vector3d(Vector3d::Unit(i)) : random.direction();
        longest = std::max(longest, adversary_step(arm, p_W, n));
      }
      worst = std::max(worst, longest / rule);
      worst_column = std::max(worst_column, longest / column);
      tightest = std::max(tightest, longest / rule);
      ++poses;
    }
    EXPECT_GE(poses, 60) << name;
    EXPECT_LE(worst, 1.001) << name;  // the arm's curvature within a step
    EXPECT_GE(tightest, 0.9) << name << ": the rule is far from sharp";
    std::printf("%s, %d poses: longest step over row sum %.4f, over column sum %.4f\n", name, poses,
                worst, worst_column);
    support::record_hard_case(4,
                              std::string("three dimensions, ") + name +
                                  ": adversary in 200 directions at " + std::to_string(poses) +
                                  " poses",
                              "<= longest step over largest row sum", worst, 1.001, "1");
  }
}

/// Returns the spectral radius of a spring of `stiffness` at the tip of an arm with inertia and
/// friction at its joints, by the exact map of each joint with torques held from sample to sample.
double joint_growth(const Matrix3d& J, const Vector3d& mass, const Vector3d& damping,
                    double stiffness, double period) {
  const Matrix3d K = stiffness * J.transpose() * J;
  Eigen::Matrix<double, 6, 6> tick = Eigen::Matrix<double, 6, 6>::Zero();
  for (int k = 0; k < 3; ++k) {
    const double rate = damping[k] / mass[k];
    const double e = std::exp(-rate * period);
    tick(k, k) = 1;
    tick(k, 3 + k) = (1 - e) / rate;
    tick(3 + k, 3 + k) = e;
    const double to_v = (1 - e) / damping[k];
    const double to_q = (period - (1 - e) / rate) / damping[k];
    tick.block<1, 3>(k, 0) -= to_q * K.row(k);
    tick.block<1, 3>(3 + k, 0) -= to_v * K.row(k);
  }
  return support::spectral_radius(tick);
}

TEST(HardCaseStiffestWall, IsStableInThreeDimensions) {
  const double period = 1e-3;
  double lowest = 1e9, highest = 0;
  int poses = 0;
  for (const char* const name : {"vintage_phantom", "woodenhaptics"}) {
    const scene::ArmFile arm = shipped(name);
    // Inertia and friction of the joints differ by up to a factor of ten.
    for (const Vector3d& mass : {Vector3d(1e-3, 1e-3, 1e-3), Vector3d(3e-3, 1e-3, 5e-4)}) {
      for (const Vector3d& damping : {Vector3d(4e-3, 4e-3, 4e-3), Vector3d(1e-3, 3e-3, 1e-2)}) {
        for (const Vector3d& p_W : scene::points_of_workspace(arm, 4)) {
          const auto J = scene::jacobian_at(arm, p_W);
          ASSERT_TRUE(J);
          const scene::TipLimits tip =
              scene::tip_limits(*J, mass.asDiagonal(), damping.asDiagonal(), joint_steps(arm));
          double low = 0.1 * tip.damping / (period / 2), high = 100 * low;
          while (high > 1.001 * low) {
            const double middle = std::sqrt(low * high);
            (joint_growth(*J, mass, damping, middle, period) < 1 ? low : high) = middle;
          }
          const double edge = low * period / 2 / tip.damping;
          lowest = std::min(lowest, edge);
          highest = std::max(highest, edge);
          ++poses;
        }
      }
    }
  }
  EXPECT_GE(lowest, 0.97);
  std::printf("%d poses: K L / least damping from %.3f to %.3f\n", poses, lowest, highest);
  support::record_hard_case(1,
                            "three dimensions, joints with inertia and friction, " +
                                std::to_string(poses) + " poses of two arms",
                            ">= least K_max L over the least damping", lowest, 0.97, "1");
}

TEST(WorstDirection, SingularPoseHasNoLimitsToOffer) {
  Matrix3d J = Matrix3d::Zero();
  J(0, 0) = J(1, 1) = 0.1;
  EXPECT_EQ(scene::tip_limits(J, Matrix3d::Identity(), Matrix3d::Identity(), {1, 1, 1}).damping, 0);
}

TEST(Tuning, LawMatchesTheFullSimulation) {
  const auto file = support::scratch_folder() / "wall.yaml";
  std::ofstream(file)
      << "name: wall\narm: " << THIMBLE_SOURCE_DIR
      << "/app/arms/vintage_phantom.yaml\nduration: 1\nobjects:\n"
         "  - {name: wall, plane: {normal: [0, 0, 1]}, stiffness: 800, damping: 1}\n"
         "hand:\n  path:\n    - {t: 0, at: [0, 0, 0.02]}\n";
  auto loaded = scene::load_scene(file);
  ASSERT_TRUE(loaded) << loaded.error().message;
  scene::Scene& scene = *loaded;
  const auto tuned = tune(scene, {.places_per_side = 2});
  ASSERT_TRUE(tuned) << tuned.error().message;
  const TuneResult& result = *tuned;
  std::printf("%s", result.text.c_str());
  for (const session::Figure& figure : result.figures) {
    if (figure.name == "wall.simulated_over_exact") {
      EXPECT_NEAR(figure.value, 1, 0.05);
    }
    if (figure.name == "wall.margin") {
      EXPECT_TRUE(figure.met()) << figure.value;
    }
  }
  EXPECT_TRUE(stability_warnings(scene).empty());
  scene.objects[0].stiffness = 8000;
  ASSERT_EQ(stability_warnings(scene).size(), 1u);
  EXPECT_NE(stability_warnings(scene)[0].find("Set its stiffness to"), std::string::npos);
  // The remedy names the key that the scene has.
  scene.objects[0].stiffness_map = render::MapChoice{.black = 0.5, .white = 1};
  EXPECT_NE(stability_warnings(scene)[0].find("Set the max of its stiffness_map to"),
            std::string::npos);
  scene.objects[0].stiffness_map = render::MapChoice{.black = 1, .white = 0.5};
  EXPECT_NE(stability_warnings(scene)[0].find("Set the min of its stiffness_map to"),
            std::string::npos);
}

}  // namespace
}  // namespace thimble::stability
