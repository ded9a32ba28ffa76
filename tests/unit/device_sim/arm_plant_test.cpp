#include "plant/arm_plant.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/random.h"
#include "support/refuses.h"
#include "vintage_simulation.h"

namespace thimble::device_sim {
namespace {

using support::refuses;

driver::Result<ArmPlant> made_with(
    const SimulatedArmSettings& settings, const Eigen::Vector3d& p_BT,
    const driver::JointModel<driver::SerialArm>& model = support::vintage_model()) {
  return ArmPlant::make(model.geometry, model.drives, settings.plant, settings.hand,
                        settings.motors, p_BT, p_BT);
}

ArmPlant plant_with(const SimulatedArmSettings& settings, const Eigen::Vector3d& p_BT) {
  return made_with(settings, p_BT).value();
}

// Returns the currents (A) that exert this force in the pose q.
Eigen::Vector3d currents_for(const Eigen::Vector3d& f_T_B, const Eigen::Vector3d& q) {
  const auto model = support::vintage_model();
  Eigen::Vector3d amperes = model.geometry.jacobian(q).transpose() * f_T_B;
  for (int i = 0; i < 3; ++i) {
    const auto& drive = model.drives[static_cast<std::size_t>(i)];
    amperes[i] *= drive.sign / (drive.ratio * drive.torque_constant);
  }
  return amperes;
}

TEST(ArmPlant, CurrentsExertTheExpectedTipForce) {
  const Eigen::Vector3d q(0.3, 1.4, 0.2);
  const Eigen::Vector3d p_BT = support::vintage_model().geometry.forward(q);
  const Eigen::Vector3d f_T_B(0.5, -0.7, 1.1);
  ArmPlant plant = plant_with(free_arm(), p_BT);
  plant.set_currents(currents_for(f_T_B, q));
  plant.step(p_BT, 1'000'000);
  EXPECT_LT((plant.f_T_B() - f_T_B).norm(), 1e-13);
  EXPECT_LT((plant.v_BT() - f_T_B / 0.1 * 1e-3).norm(), 1e-15);
  EXPECT_LT((plant.p_BT() - p_BT - f_T_B / 0.1 * 0.5e-6).norm(), 1e-16);
}

TEST(ArmPlant, SaturatesEachMotor) {
  ArmPlant plant = plant_with(free_arm(), home_tip());
  plant.set_currents({5, -7, 1});
  EXPECT_EQ(plant.currents(), Eigen::Vector3d(3, -3, 1));
  plant.set_currents({std::numeric_limits<double>::quiet_NaN(), HUGE_VAL, 0});
  EXPECT_EQ(plant.currents(), Eigen::Vector3d(0, 3, 0));
}

// Accelerates a free arm under constant torque for 40 ms, in sub-steps of the given length.
Eigen::Vector3d oscillation(std::int64_t step_ns) {
  ArmPlant plant = plant_with(free_arm(), home_tip());
  plant.set_currents({1.0, 0.8, -0.6});
  for (std::int64_t t = 0; t < 40'000'000; t += step_ns) plant.step(home_tip(), step_ns);
  return plant.p_BT();
}

TEST(ArmPlant, ErrorIsSecondOrderInTheSubStep) {
  const Eigen::Vector3d truth = oscillation(1'000);
  const double coarse = (oscillation(1'000'000) - truth).norm();
  const double fine = (oscillation(500'000) - truth).norm();
  EXPECT_GT((truth - home_tip()).norm(), 0.01);
  EXPECT_LT(coarse, 1e-6);
  EXPECT_NEAR(coarse / fine, 4, 0.4);
}

TEST(ArmPlant, KineticEnergyEqualsTheWorkOfTheTorque) {
  ArmPlant plant = plant_with(free_arm(), home_tip());
  const Eigen::Vector3d amperes(1.0, 0.8, -0.6);
  plant.set_currents(amperes);
  const Eigen::Vector3d q_before = plant.q();
  for (int k = 0; k < 40; ++k) plant.step(home_tip(), 1'000'000);
  double work = 0;
  const auto model = support::vintage_model();
  for (int i = 0; i < 3; ++i) {
    const auto& drive = model.drives[static_cast<std::size_t>(i)];
    work += drive.sign * drive.ratio * drive.torque_constant * amperes[i] *
            (plant.q()[i] - q_before[i]);
  }
  EXPECT_NEAR(0.5 * 0.1 * plant.v_BT().squaredNorm() / work, 1, 1e-4);
}

TEST(ArmPlant, StopsAtTheEndOfItsReachAndComesBack) {
  HandSettings hand;
  hand.stiffness = 100;
  hand.damping = 2;
  SimulatedArmSettings settings = free_arm();
  settings.hand = hand;
  ArmPlant held = plant_with(settings, home_tip());
  const auto model = support::vintage_model();
  for (int k = 0; k < 2000; ++k) {
    held.step({0.5, 0, 0}, 1'000'000);
    ASSERT_TRUE(model.geometry.inverse(held.p_BT()).has_value());
  }
  EXPECT_GT(held.stops(), 100U);
  EXPECT_LT(held.p_BT().norm(), 0.25);
  EXPECT_GT(held.p_BT().norm(), 0.2);
  const std::uint64_t stops = held.stops();
  for (int k = 0; k < 2000; ++k) held.step(home_tip(), 1'000'000);
  EXPECT_LT((held.p_BT() - home_tip()).norm(), 1e-3);
  EXPECT_LE(held.stops(), stops + 1);
}

TEST(ArmPlant, StaysFiniteUnderFullCurrentsInAnyDirection) {
  support::Random random(9);
  for (int run = 0; run < 200; ++run) {
    ArmPlant plant = plant_with(phantom_like(), home_tip());
    const Eigen::Vector3d target = random.in_box(0.4);
    for (int k = 0; k < 300; ++k) {
      if (k % 50 == 0) plant.set_currents(random.in_box(3));
      plant.step(target, 1'000'000);
      ASSERT_TRUE(plant.p_BT().allFinite() && plant.v_BT().allFinite());
      ASSERT_TRUE(plant.q().allFinite());
    }
  }
}

TEST(ArmPlant, RefusesImpossibleStartsAndConstants) {
  EXPECT_TRUE(refuses(made_with(free_arm(), {1, 0, 0}), "starting point"));
  SimulatedArmSettings settings = free_arm();
  settings.motors.current_max = 0;
  EXPECT_TRUE(refuses(made_with(settings, home_tip()), "current_max"));
  settings = free_arm();
  settings.plant.mass = 0;
  EXPECT_TRUE(refuses(made_with(settings, home_tip()), "tip mass"));
  auto model = support::vintage_model();
  model.drives[2].ratio = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refuses(made_with(free_arm(), home_tip(), model), "motor drives"));
  model = support::vintage_model();
  model.geometry.length_b = 0;
  EXPECT_TRUE(refuses(made_with(free_arm(), home_tip(), model), "links"));
}

}  // namespace
}  // namespace thimble::device_sim
