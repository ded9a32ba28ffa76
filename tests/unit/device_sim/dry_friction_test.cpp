#include "plant/dry_friction.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "plant/drive_train_plant.h"
#include "support/random.h"
#include "vintage_simulation.h"

namespace thimble::device_sim {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kMillisecond = 1'000'000;

driver::SerialArm geometry() {
  return support::vintage_model().geometry;
}

/// An arm with friction in its joints and none at its tip.
SimulatedArmSettings rubbing_arm(const Vector3d& coulomb, const Vector3d& viscous) {
  SimulatedArmSettings settings = free_arm();
  settings.drive_train.coulomb = coulomb;
  settings.drive_train.viscous = viscous;
  return settings;
}

LinkedSerialPlant plant_with(const SimulatedArmSettings& settings, const Vector3d& p_BT) {
  return LinkedSerialPlant::make(support::vintage_model(), settings, p_BT, p_BT).value();
}

/// Sets the velocity of the tip (m/s) in its present pose.
void set_off(LinkedSerialPlant& plant, const Vector3d& v_BT) {
  plant.put({.p_BT = plant.p_BT(), .v_BT = v_BT, .q_rotor = plant.q()});
}

/// Returns the angular momentum of the tip about the axis of joint A, kg m^2/s.
double moment_about_a(const LinkedSerialPlant& plant, double mass) {
  const Vector3d lever = geometry().jacobian(plant.q()).col(0);
  return mass * lever.dot(plant.v_BT());
}

TEST(DryFriction, TipFrictionIsTheUniqueSolution) {
  support::Random random(9);
  const auto any = [&] {
    return Eigen::Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  int held = 0, turned = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Eigen::Matrix3d root;
    root << any(), any(), any();
    const Eigen::Matrix3d inertia = root * root.transpose() + 0.05 * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d momentum = any();
    const Eigen::Vector3d before = trial % 3 == 0 ? Eigen::Vector3d(0, 0, 0) : any();
    constexpr double kTipFriction = 0.3;
    const Eigen::Vector3d v =
        velocity_after_friction(inertia, momentum, {.tip = kTipFriction}, before);
    const Eigen::Vector3d friction = momentum - inertia * v;
    for (int i = 0; i < 3; ++i) {
      if (v[i] == 0) {
        ++held;
        ASSERT_LE(std::abs(friction[i]), kTipFriction * (1 + 1e-9));
      } else {
        ASSERT_NEAR(friction[i], std::copysign(kTipFriction, v[i]), 1e-9);
        turned += v[i] * before[i] < 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(held, 500);
  EXPECT_GT(turned, 500);
}

TEST(DryFriction, TipAndJointFrictionIsTheUniqueSolution) {
  support::Random random(10);
  const auto any = [&] {
    return Vector3d(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
  };
  int stood = 0, held = 0, slid = 0;
  for (int trial = 0; trial < 2000; ++trial) {
    Eigen::Matrix3d root, G;
    root << any(), any(), any();
    G << any(), any(), any();
    const Eigen::Matrix3d inertia = root * root.transpose() + 0.05 * Eigen::Matrix3d::Identity();
    DryFriction friction{.tip = trial % 2 == 0 ? 0.0 : 0.1,
                         .joints = 0.4 * any().cwiseAbs(),
                         .G = Eigen::Matrix3d::Identity() + 0.4 * G};
    const Vector3d momentum = any();
    const Vector3d before = trial % 3 == 0 ? Vector3d(0, 0, 0) : any();
    const Vector3d v = velocity_after_friction(inertia, momentum, friction, before);
    // The solution minimises kinetic energy plus the energy lost to friction, so any small
    // deviation costs energy.
    const auto cost = [&](const Vector3d& at) {
      return 0.5 * at.dot(inertia * at) - momentum.dot(at) + friction.tip * at.lpNorm<1>() +
             friction.joints.dot((friction.G * at).cwiseAbs());
    };
    for (int way = 0; way < 20; ++way) {
      const Vector3d off = v + 1e-3 * any();
      ASSERT_LE(cost(v), cost(off) + 1e-13) << trial;
    }
    stood += v.isZero(0) ? 1 : 0;
    for (int joint = 0; joint < 3; ++joint) {
      const double rate = std::abs(friction.G.row(joint).dot(v));
      (rate < 1e-10 ? held : slid) += 1;
    }
  }
  EXPECT_GT(stood, 20);
  EXPECT_GT(held, 500);
  EXPECT_GT(slid, 500);
}

TEST(DryFriction, PointTipRefusesJointFriction) {
  EXPECT_FALSE(SerialDriveTrainPlant::make(
      support::vintage_model(), rubbing_arm({0, 0.001, 0}, {0, 0, 0}), home_tip(), home_tip()));
}

TEST(DryFriction, JointFrictionReducesItsMomentumUniformly) {
  constexpr double kTorque = 0.004;
  const SimulatedArmSettings settings = rubbing_arm({kTorque, 0, 0}, {0, 0, 0});
  LinkedSerialPlant plant = plant_with(settings, home_tip());
  // Across the plane of the links, and a little outwards, which does not turn the joint.
  const Vector3d across = geometry().jacobian(plant.q()).col(0).normalized();
  set_off(plant, 0.1 * across + Vector3d(0, 0, 0.01));
  const double moment = moment_about_a(plant, settings.plant.mass);
  ASSERT_GT(std::abs(moment), 1e-4);
  const double stands_after = std::abs(moment) / kTorque;
  double time = 0;
  while (time < 1.2 * stands_after) {
    plant.step(plant.p_BH(), kMillisecond);
    time += 1e-3;
    const double left = std::max(0.0, std::abs(moment) - kTorque * time);
    ASSERT_NEAR(std::abs(moment_about_a(plant, settings.plant.mass)), left,
                1e-4 * std::abs(moment) + 1e-4 * kTorque)
        << time;
  }
  EXPECT_NEAR(plant.v_BT().z(), 0.01, 1e-9) << "no other joint has friction";
}

TEST(DryFriction, JointFrictionDissipatesTorqueTimesAngle) {
  const Vector3d coulomb(0.01, 0.02, 0.015), viscous(2e-3, 1e-3, 3e-3);
  const SimulatedArmSettings settings = rubbing_arm(coulomb, viscous);
  LinkedSerialPlant plant = plant_with(settings, home_tip());
  set_off(plant, {0.1, -0.08, 0.12});
  const double begin = 0.5 * settings.plant.mass * plant.v_BT().squaredNorm();
  double taken = 0;
  for (int k = 0; k < 1000; ++k) {
    const Vector3d before = plant.q();
    plant.step(plant.p_BH(), 50'000);
    const Vector3d way = plant.q() - before;
    taken += coulomb.dot(way.cwiseAbs()) + viscous.dot(way.cwiseAbs2()) / 50e-6;
  }
  const double left = 0.5 * settings.plant.mass * plant.v_BT().squaredNorm();
  ASSERT_LT(left, 0.7 * begin);
  EXPECT_NEAR(taken, begin - left, 1e-4 * begin);
}

TEST(DryFriction, JointFrictionHoldsExactlyUpToItsTorque) {
  const Vector3d coulomb(0.002, 0.003, 0.0025);
  for (int joint = 0; joint < 3; ++joint) {
    for (const double share : {0.99, 1.01}) {
      LinkedSerialPlant plant = plant_with(rubbing_arm(coulomb, {0, 0, 0}), home_tip());
      const Vector3d place = plant.p_BT();
      const Eigen::Matrix3d J = geometry().jacobian(plant.q());
      plant.set_pull(J.inverse().transpose() * (share * coulomb[joint] * Vector3d::Unit(joint)));
      for (int k = 0; k < 50; ++k) plant.step(plant.p_BH(), kMillisecond);
      if (share < 1) {
        EXPECT_EQ(plant.p_BT(), place) << joint;
      } else {
        const Vector3d rate = J.inverse() * plant.v_BT();
        EXPECT_GT(rate[joint], 1e-4) << joint;
        for (int other = 0; other < 3; ++other) {
          if (other == joint) continue;
          EXPECT_LT(std::abs(rate[other]), 0.05 * rate[joint]) << other;
        }
      }
    }
  }
}

}  // namespace
}  // namespace thimble::device_sim
