#include "plant/drive_train_plant.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <functional>

#include "support/refuses.h"
#include "vintage_simulation.h"

namespace thimble::device_sim {
namespace {

using support::refuses;

constexpr std::int64_t kMillisecond = 1'000'000;
// The yaw of the vintage arm at its home pose: N m/A at the joint, and rad/m at the tip.
constexpr double kYawTorque = -9.0 * 0.0234, kYawTurn = 1 / 0.138;

SerialDriveTrainPlant plant_with(const SimulatedArmSettings& settings,
                                 const Eigen::Vector3d& p_BT = home_tip()) {
  return SerialDriveTrainPlant::make(support::vintage_model(), settings, p_BT, p_BT).value();
}

Eigen::Vector3d link_angles(const SerialDriveTrainPlant& plant) {
  return support::vintage_model().geometry.inverse(plant.p_BT()).value();
}

/// A free arm whose motors turn the links through elastic cables.
SimulatedArmSettings compliant_arm(double damping = 0) {
  SimulatedArmSettings settings = free_arm();
  settings.drive_train.inertia.setConstant(1e-3);
  settings.drive_train.stiffness.setConstant(200);
  settings.drive_train.damping.setConstant(damping);
  return settings;
}

TEST(DriveTrainPlant, FallsUnderItsWeight) {
  SimulatedArmSettings settings = free_arm();
  settings.weight_B = {0, 0, -0.2};
  SerialDriveTrainPlant plant = plant_with(settings);
  for (int k = 1; k <= 100; ++k) {
    plant.step(home_tip(), kMillisecond);
    const double t = 1e-3 * k;
    ASSERT_LT((plant.p_BT() - home_tip() - Eigen::Vector3d(0, 0, -t * t)).norm(), 1e-14);
  }
}

TEST(DriveTrainPlant, RigidDriveTrainIsTheIdealArm) {
  SimulatedArmSettings settings = phantom_like();
  SerialDriveTrainPlant plant = plant_with(settings);
  const auto model = support::vintage_model();
  ArmPlant ideal = ArmPlant::make(model.geometry, model.drives, settings.plant, settings.hand,
                                  settings.motors, home_tip(), home_tip())
                       .value();
  for (int k = 0; k < 200; ++k) {
    const Eigen::Vector3d amperes(0.5 * std::sin(0.1 * k), 0.3, 0.4 * std::cos(0.07 * k));
    plant.set_currents(amperes);
    ideal.set_currents(amperes);
    plant.step(home_tip(), kMillisecond);
    // In sub-steps as short as those of the other plant.
    for (int part = 0; part < 40; ++part) ideal.step(home_tip(), kMillisecond / 40);
    ASSERT_LT((plant.p_BT() - ideal.p_BT()).norm(), 1e-12);
    ASSERT_LT((plant.q() - ideal.q()).norm(), 1e-11);
  }
  EXPECT_GT((plant.p_BT() - home_tip()).norm(), 1e-3);
}

TEST(DriveTrainPlant, CurrentLagMatchesItsClosedForm) {
  constexpr double kLag = 2e-3, kAmperes = 1e-3;
  SimulatedArmSettings settings = free_arm();
  settings.drive_train.current_lag = kLag;
  SerialDriveTrainPlant plant = plant_with(settings);
  plant.set_currents({kAmperes, 0, 0});
  const double a = kYawTorque * kAmperes * kYawTurn / 0.1;
  for (int k = 1; k <= 10; ++k) {
    plant.step(home_tip(), kMillisecond);
    const double t = 1e-3 * k, risen = -std::expm1(-t / kLag);
    ASSERT_NEAR(plant.currents().x(), kAmperes * risen, 1e-15);
    // From now on the motion of the tip along y is the integral of the currents.
    ASSERT_NEAR(plant.v_BT().y() / (a * (t - kLag * risen)), 1, 1e-6);
    const double way = a * (t * t / 2 - kLag * t + kLag * kLag * risen);
    ASSERT_NEAR((plant.p_BT() - home_tip()).y(), way, 5e-4 * std::abs(way));
  }
}

/// Returns the stretch (rad) of the yaw cable at a time (s) after its motor began to pull with
/// kYawTorque times `amperes`: a free oscillation of two masses.
double stretch_at(double t, double amperes, double damping) {
  const double per_inertia = 1 / 1e-3 + kYawTurn * kYawTurn / 0.1;
  const double w2 = 200 * per_inertia, decay = 0.5 * damping * per_inertia;
  const double w = std::sqrt(w2 - decay * decay);
  const double still = kYawTorque * amperes / 1e-3 / w2;
  return still * (1 - std::exp(-decay * t) * (std::cos(w * t) + decay / w * std::sin(w * t)));
}

TEST(DriveTrainPlant, OscillatesLikeTwoMassesOnACable) {
  for (const double damping : {0.0, 0.02, 0.1}) {
    SerialDriveTrainPlant plant = plant_with(compliant_arm(damping));
    constexpr double kAmperes = 1e-3;
    plant.set_currents({kAmperes, 0, 0});
    const double most = 2 * std::abs(kYawTorque) * kAmperes / 1e-3 / (200 * 1525.0);
    for (int k = 1; k <= 100; ++k) {
      plant.step(home_tip(), kMillisecond);
      ASSERT_NEAR(plant.q()[0] - link_angles(plant)[0], stretch_at(1e-3 * k, kAmperes, damping),
                  1e-3 * most)
          << "after " << k << " ms with damping " << damping;
    }
  }
}

TEST(DriveTrainPlant, CablesConserveEnergy) {
  SerialDriveTrainPlant plant = plant_with(compliant_arm());
  // A push of 1 ms, then free motion.
  plant.set_currents({0.02, 0.03, -0.01});
  plant.step(home_tip(), kMillisecond);
  plant.set_currents({0, 0, 0});
  const auto largest_stretch = [&] {
    double most = 0;
    for (int k = 0; k < 4000; ++k) {
      plant.step(home_tip(), kMillisecond / 20);
      most = std::max(most, (plant.q() - link_angles(plant)).norm());
    }
    return most;
  };
  const double first = largest_stretch();
  for (int k = 0; k < 2000; ++k) plant.step(home_tip(), kMillisecond);
  EXPECT_GT(first, 1e-5);
  EXPECT_NEAR(largest_stretch() / first, 1, 0.02);
}

TEST(DriveTrainPlant, MotorCrossesBacklashWithoutForceOnTheTip) {
  constexpr double kPlay = 2e-3;
  SimulatedArmSettings settings = compliant_arm(0.05);
  settings.drive_train.play.setConstant(kPlay);
  settings.drive_train.viscous.setConstant(0.05);
  settings.hand = {.mass = 0, .stiffness = 2000, .damping = 20};
  SerialDriveTrainPlant plant = plant_with(settings);
  const auto stretched = [&] { return plant.q()[0] - link_angles(plant)[0]; };
  double ends[2];
  int slack = 0;
  for (int end = 0; end < 2; ++end) {
    plant.set_currents({end == 0 ? -0.5 : 0.5, 0, 0});
    for (int k = 0; k < 100'000; ++k) {
      const double before = stretched();
      plant.step(home_tip(), SerialDriveTrainPlant::kSubStep_ns);
      // Well inside the backlash at both ends of the sub-step.
      if (std::max(std::abs(before), std::abs(stretched())) > 0.4 * kPlay) continue;
      ++slack;
      ASSERT_EQ(plant.f_T_B().y(), 0);
    }
    ends[end] = stretched();
  }
  EXPECT_GT(slack, 20);
  EXPECT_NEAR(ends[0] - ends[1], kPlay + 2 * std::abs(kYawTorque) * 0.5 / 200, 1e-8);
}

TEST(DriveTrainPlant, DryFrictionHoldsTheMotors) {
  SimulatedArmSettings settings = compliant_arm(0.02);
  settings.drive_train.coulomb.setConstant(0.02);
  SerialDriveTrainPlant plant = plant_with(settings);
  const Eigen::Vector3d q = plant.q();
  plant.set_currents({0.019 / kYawTorque, 0, 0});
  for (int k = 0; k < 100; ++k) plant.step(home_tip(), kMillisecond);
  EXPECT_EQ(plant.q(), q);
  plant.set_currents({0.021 / kYawTorque, 0, 0});
  for (int k = 0; k < 100; ++k) plant.step(home_tip(), kMillisecond);
  EXPECT_GT(plant.q()[0] - q[0], 1e-3);
}

TEST(DriveTrainPlant, MotorsAddApparentMassInEachPose) {
  for (const Eigen::Vector3d& p_BT :
       {home_tip(), Eigen::Vector3d(home_tip() + Eigen::Vector3d(0.06, -0.05, 0.04))}) {
    SimulatedArmSettings settings = compliant_arm(2);
    settings.drive_train.stiffness.setConstant(5e3);
    SerialDriveTrainPlant plant = plant_with(settings, p_BT);
    const auto model = support::vintage_model();
    const Eigen::Matrix3d J = model.geometry.jacobian(model.geometry.inverse(p_BT).value());
    const Eigen::Matrix3d G = J.inverse();
    const Eigen::Matrix3d mass = 0.1 * Eigen::Matrix3d::Identity() + G.transpose() * (1e-3 * G);
    const Eigen::Vector3d amperes(1e-3, 2e-3, -1e-3);
    Eigen::Vector3d tau;
    for (int i = 0; i < 3; ++i) {
      const auto& drive = model.drives[static_cast<std::size_t>(i)];
      tau[i] = drive.sign * drive.ratio * drive.torque_constant * amperes[i];
    }
    plant.set_currents(amperes);
    for (int k = 0; k < 50; ++k) plant.step(p_BT, kMillisecond);
    const Eigen::Vector3d v = 0.05 * mass.inverse() * G.transpose() * tau;
    EXPECT_LT((plant.v_BT() - v).norm(), 5e-3 * v.norm());
  }
}

TEST(DriveTrainPlant, CoggingPullsMotorsTowardsTheirPoles) {
  constexpr double kCogging = 0.005, kPeriods = 7, kAngle = 2e-4;
  SimulatedArmSettings settings = free_arm();
  settings.drive_train.cogging.x() = kCogging;
  settings.drive_train.periods_per_turn = kPeriods;
  const Eigen::Vector3d turned(0.138 * std::cos(kAngle), 0.138 * std::sin(kAngle), home_tip().z());
  SerialDriveTrainPlant plant = plant_with(settings, turned);
  const double w = std::sqrt(81 * kPeriods * kCogging * kYawTurn * kYawTurn / 0.1);
  for (int k = 1; k <= 200; ++k) {
    plant.step(turned, kMillisecond);
    ASSERT_NEAR(plant.q()[0], kAngle * std::cos(w * 1e-3 * k), 1e-3 * kAngle);
  }
}

TEST(DriveTrainPlant, TorqueRipplesWithTheMotorAngle) {
  SimulatedArmSettings settings = free_arm();
  settings.drive_train.ripple.setConstant(0.1);
  settings.drive_train.periods_per_turn = 6;
  for (const double yaw : {0.0, 0.01, 0.03, -0.02}) {
    const Eigen::Vector3d turned(0.138 * std::cos(yaw), 0.138 * std::sin(yaw), home_tip().z());
    SerialDriveTrainPlant plant = plant_with(settings, turned);
    plant.set_currents({0.1, 0, 0});
    plant.step(turned, 1000);
    const double nominal = std::abs(kYawTorque) * 0.1 * kYawTurn;
    EXPECT_NEAR(plant.f_T_B().norm(), nominal * (1 + 0.1 * std::sin(6 * 9 * yaw)), 1e-9);
  }
}

TEST(DriveTrainPlant, PhasesShiftCoggingAndRipple) {
  SimulatedArmSettings settings = free_arm();
  settings.drive_train.cogging.x() = 0.001;
  settings.drive_train.cogging_phase.x() = 0.4;
  settings.drive_train.ripple.x() = 0.1;
  settings.drive_train.ripple_phase.x() = -1.1;
  settings.drive_train.periods_per_turn = 6;
  for (const double yaw : {0.0, 0.01, -0.02}) {
    const Eigen::Vector3d turned(0.138 * std::cos(yaw), 0.138 * std::sin(yaw), home_tip().z());
    SerialDriveTrainPlant plant = plant_with(settings, turned);
    plant.set_currents({0.1, 0, 0});
    plant.step(turned, 1000);
    const double driven = kYawTorque * 0.1 * (1 + 0.1 * std::sin(6 * 9 * yaw - 1.1));
    const double cogged = 9 * 0.001 * std::sin(6 * 9 * yaw + 0.4);
    EXPECT_NEAR(plant.f_T_B().norm(), std::abs(driven - cogged) * kYawTurn, 1e-9);
  }
}

TEST(DriveTrainPlant, StopsAtTheEndOfItsReachAndComesBack) {
  SimulatedArmSettings settings = compliant_arm(0.05);
  settings.hand = {.mass = 0, .stiffness = 100, .damping = 2};
  SerialDriveTrainPlant plant = plant_with(settings);
  for (int k = 0; k < 1000; ++k) plant.step({0.5, 0, 0}, kMillisecond);
  EXPECT_GT(plant.stops(), 100U);
  EXPECT_LT(plant.p_BT().norm(), 0.25);
  for (int k = 0; k < 3000; ++k) plant.step(home_tip(), kMillisecond);
  EXPECT_LT((plant.p_BT() - home_tip()).norm(), 1e-3);
}

TEST(DriveTrainPlant, RefusesImpossibleSettings) {
  const auto made_with = [](const std::function<void(SimulatedArmSettings&)>& change) {
    SimulatedArmSettings settings = compliant_arm();
    change(settings);
    return SerialDriveTrainPlant::make(support::vintage_model(), settings, home_tip(), home_tip());
  };
  EXPECT_TRUE(made_with([](auto&) {}).ok());
  EXPECT_TRUE(refuses(made_with([](auto& s) { s.drive_train.current_lag = -1; }), "current_lag"));
  EXPECT_TRUE(refuses(made_with([](auto& s) { s.drive_train.play.y() = NAN; }), "play"));
  EXPECT_TRUE(refuses(made_with([](auto& s) { s.drive_train.stiffness.x() = 0; }), "stiffness"));
  EXPECT_TRUE(refuses(made_with([](auto& s) { s.drive_train.inertia.z() = 0; }), "inertia"));
  EXPECT_TRUE(refuses(made_with([](auto& s) { s.drive_train.cogging.x() = 0.1; }), "periods"));
  EXPECT_TRUE(refuses(made_with([](auto& s) { s.drive_train.ripple_phase.z() = NAN; }), "phase"));
  EXPECT_TRUE(refuses(made_with([](auto& s) { s.drive_train.stiffness.setZero(); }),
                      "require a stiffness"));
  EXPECT_TRUE(refuses(made_with([](auto& s) { s.weight_B.z() = HUGE_VAL; }), "weight"));
  EXPECT_TRUE(refuses(made_with([](auto& s) { s.motors.current_max = 0; }), "current_max"));
}

}  // namespace
}  // namespace thimble::device_sim
