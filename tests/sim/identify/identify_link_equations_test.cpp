// Forces of links in the weak form, compared with rigid bodies whose equations of motion are
// derived only from their positions and rotations (support/identify/rigid_links.h).
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "bringup/identify/link_inertia/link_equations.h"
#include "bringup/identify/smooth_bump.h"
#include "support/identify/rigid_links.h"

namespace thimble::bringup {
namespace {

using support::LinkBody;
using support::RigidLinks;
using Index = LinkEquations::Index;

const Eigen::Vector3d kGravity(1.2, -2.1, -9.4);  // gravity in a tilted base, m/s^2
const driver::SerialArm kSomeArm{.height = 0.02, .length_b = 0.138, .length_c = 0.112};

/// Returns joint angles over time: about 10 degrees back and forth at 1 to 3 Hz, as fast as in an
/// identification. They are far from the symmetric pose, so that no term is small by chance.
Eigen::Vector3d angles_at(double t) {
  return {0.3 + 0.15 * std::sin(9 * t), 1.2 + 0.16 * std::sin(13 * t + 1),
          0.5 + 0.14 * std::sin(17 * t + 2)};
}

constexpr double kTick = 1e-3;

ArmMotion links_motion() {
  ArmMotion motion;
  motion.down_B = kGravity.normalized();
  for (int k = 0; k < 700; ++k) {
    MotionSample sample;
    sample.q = angles_at(kTick * k);
    Eigen::Matrix3d J;
    kSomeArm.forward(sample.q, sample.p_BT, J);
    sample.G = J.inverse();
    sample.fresh = true;
    motion.samples.push_back(sample);
  }
  return motion;
}

/// Returns the force of the bodies along an axis, averaged over an equation's bump, with time
/// derivatives of the exact angles.
double taken(const RigidLinks& links, const ArmMotion& motion,
             const MotionEquations::Equation& equation) {
  constexpr double h = 1e-4;
  const SmoothBump<MotionEquations::kHalf> bump(motion.dt);
  double sum = 0, area = 0;
  for (int j = -MotionEquations::kHalf; j <= MotionEquations::kHalf; ++j) {
    const double t = kTick * (equation.middle + j);
    const Eigen::Vector3d q = angles_at(t), rate = (angles_at(t + h) - angles_at(t - h)) / (2 * h),
                          turned = (angles_at(t + h) - 2 * q + angles_at(t - h)) / (h * h);
    const Eigen::Vector3d tau = links.inertia(q) * turned - links.torque(q, rate);
    const double weight = bump.value[static_cast<std::size_t>(j + MotionEquations::kHalf)];
    const auto tick = static_cast<std::size_t>(equation.middle + j);
    sum += weight * motion.samples[tick].G.col(equation.axis).dot(tau);
    area += weight;
  }
  return sum / area;
}

/// Expects that the forces from rows equal those of the bodies along each axis, within a share of
/// the largest.
void expect_equal(
    const RigidLinks& links,
    const std::function<double(const LinkEquations&, const MotionEquations::Equation&)>& by_row,
    const std::string& name) {
  const ArmMotion motion = links_motion();
  const LinkEquations equations(motion);
  const MotionEquations moved(motion, false);
  double most = 0, apart = 0;
  std::array<int, 3> seen{};
  for (const auto& equation : moved.equations()) {
    const double truth = taken(links, motion, equation);
    most = std::max(most, std::abs(truth));
    apart = std::max(apart, std::abs(by_row(equations, equation) - truth));
    ++seen[static_cast<std::size_t>(equation.axis)];
  }
  for (const int count : seen) EXPECT_GT(count, 10) << name;
  EXPECT_LT(apart, 2e-3 * most) << name << " of up to " << most << " N";
  EXPECT_GT(most, 0) << name;
}

constexpr double kGravityConstant = 9.80665;  // gravity in a row, m/s^2

TEST(LinkEquations, EachConstantMatchesLagrange) {
  // Gravity scaled to the value of a row.
  const Eigen::Vector3d gravity = kGravityConstant * kGravity.normalized();
  const double along = 0.6;
  struct One {
    Index constant;
    std::string name;
    LinkBody body;
  };
  const auto at = [](int i) { return static_cast<Index>(i); };
  const std::vector<One> all{
      {at(0), "inertia A", {.axial = 1, .third = 1}},
      {at(1), "inertia B", {.pitch = 1}},
      {at(2), "inertia C", {.turns_with_c = true, .pitch = 1}},
      {LinkEquations::kYawB, "yaw_b", {.third = 1}},
      {LinkEquations::kYawC, "yaw_c", {.turns_with_c = true, .third = 1}},
      // The effect of its mass is subtracted again.
      {LinkEquations::kMomentB,
       "moment_b",
       {.mass = 1 / along, .along_b = along, .pitch = -along, .third = -along}}};
  for (const One& one : all) {
    expect_equal(
        RigidLinks({one.body}, gravity),
        [&](const LinkEquations& links, const MotionEquations::Equation& equation) {
          return links.row(equation)[one.constant];
        },
        one.name);
  }
}

TEST(LinkEquations, ExpressAnyLinksWithMassAndWeightAtTheTip) {
  // Coupling and moment_c have no column: mass and weight at the tip and the other columns express
  // them.
  const Eigen::Vector3d gravity = kGravityConstant * kGravity.normalized();
  const RigidLinks links = support::desk_links(kSomeArm, 1, gravity);
  const device_sim::LinkSettings all = links.settings();
  const double lb = kSomeArm.length_b, lc = kSomeArm.length_c;
  const double mass = all.coupling / (lb * lc), weighs = all.moment_c / lc;
  LinkEquations::Row constants;
  constants << all.inertia - mass * Eigen::Vector3d(0, lb * lb, lc * lc),
      all.yaw_b - mass * lb * lb, all.yaw_c - mass * lc * lc, all.moment_b - weighs * lb;
  ASSERT_GT(std::abs(mass), 1e-3);
  ASSERT_GT(std::abs(weighs), 1e-3);
  expect_equal(
      links,
      [&](const LinkEquations& rows, const MotionEquations::Equation& equation) {
        return rows.row(equation).dot(constants) + mass * equation.left -
               weighs * gravity[equation.axis];
      },
      "desk links");
}

TEST(LinkEquations, KnownLinksAddTheirForcePerMass) {
  const RigidLinks links =
      support::desk_links(kSomeArm, 1, kGravityConstant * kGravity.normalized());
  LinkEquations::Row constants;
  constants << 2e-4, 3e-4, 4e-4, 5e-4, 6e-4, 7e-4;
  ArmMotion motion = links_motion();
  const MotionEquations without(motion, false);
  const LinkEquations rows(motion);
  motion.links = constants / 0.05;
  const MotionEquations with(motion, false);
  ASSERT_EQ(with.equations().size(), without.equations().size());
  for (std::size_t i = 0; i < with.equations().size(); ++i) {
    const auto& equation = without.equations()[i];
    ASSERT_NEAR(0.05 * with.equations()[i].left,
                0.05 * equation.left + rows.row(equation).dot(constants), 1e-12);
  }
}

TEST(LinkEquations, MassMatrixAtTheTipMatchesTheBodies) {
  const ArmMotion motion = links_motion();
  const RigidLinks links({{.axial = 2e-4, .pitch = 3e-4, .third = 5e-4},
                          {.turns_with_c = true, .axial = 1e-4, .pitch = 4e-4, .third = 7e-4}},
                         Eigen::Vector3d::Zero());
  const device_sim::LinkSettings all = links.settings();
  LinkEquations::Row constants;
  constants << all.inertia, all.yaw_b, all.yaw_c, 0;
  for (const std::size_t k : {std::size_t{5}, std::size_t{300}}) {
    const MotionSample& sample = motion.samples[k];
    const Eigen::Matrix3d M = sample.G.transpose() * links.inertia(sample.q) * sample.G;
    EXPECT_LT((links_at_tip(constants, sample) - M).norm(), 1e-6 * M.norm());
  }
}

}  // namespace
}  // namespace thimble::bringup
