#include <Eigen/Geometry>
#include <atomic>
#include <cmath>
#include <random>
#include <thread>
#include <utility>

#include "compat/dhd/dhd_test.h"
#include "compat/dhd/straight_path.h"
#include "support/seed.h"

namespace thimble::compat {
namespace {

Eigen::Vector3d tip() {
  Eigen::Vector3d p;
  EXPECT_EQ(dhdGetPosition(&p[0], &p[1], &p[2], 0), 0);
  return p;
}

// Waits for some ticks of the regulation.
void wait_for(double seconds) {
  ArmReading reading;
  arms::read(0, reading);
  const std::int64_t end = reading.time_ns + static_cast<std::int64_t>(1e9 * seconds);
  while (arms::read(0, reading) && reading.time_ns < end) std::this_thread::yield();
}

TEST(StraightPath, TakesTheShortestTimeWithinItsBounds) {
  std::mt19937 random(static_cast<std::uint32_t>(support::seed_of(3)));
  std::uniform_real_distribution<double> decade(-2, 2);
  for (int i = 0; i < 200; ++i) {
    const dhd::PathBounds bounds{.acceleration = std::pow(10, decade(random)),
                                 .speed = std::pow(10, decade(random)),
                                 .jerk = std::pow(10, decade(random) + 1)};
    const Eigen::Vector3d from(0.1, 0.2, 0.3), along(0.2, -0.1, 0.05), to = from + along;
    const dhd::StraightPath path(from, to, bounds);
    EXPECT_EQ(path.at(0), from);
    EXPECT_EQ(path.at(path.duration()), to);
    const double length = along.norm(), h = path.duration() / 2000;
    const auto s = [&](double t) { return (path.at(t) - from).norm(); };
    double speed = 0, acceleration = 0, jerk = 0;
    for (int k = 2; k < 1998; ++k) {
      const double t = k * h;
      ASSERT_LT((path.at(t) - from).cross(along).norm(), 1e-12) << "a straight line";
      speed = std::max(speed, std::abs(s(t + h) - s(t - h)) / (2 * h));
      acceleration = std::max(acceleration, std::abs(s(t + h) - 2 * s(t) + s(t - h)) / (h * h));
      jerk = std::max(jerk, std::abs(s(t + 2 * h) - 2 * s(t + h) + 2 * s(t - h) - s(t - 2 * h)) /
                                (2 * h * h * h));
    }
    const double used =
        std::max({speed / bounds.speed, acceleration / bounds.acceleration, jerk / bounds.jerk});
    EXPECT_LT(used, 1.001) << "of " << length << " m";
    EXPECT_GT(used, 0.98);
  }
}

TEST_F(CompatDhd, RegulationHoldsTheTipAgainstAPush) {
  begin_and_open({.held = false});
  ASSERT_EQ(drdAutoInit(), 0);
  ASSERT_EQ(drdStart(), 0);
  EXPECT_TRUE(drdIsRunning());
  wait_for(0.2);
  fake::change(0, [](ArmReading& now) { now.p_WT = {0, 0.003, 0}; });
  EXPECT_LT(fake::f_sent_W(0).norm(), 5.01);
  wait_for(1);
  EXPECT_LT(tip().norm(), 1e-5) << "the spring took it back";
  EXPECT_FALSE(drdIsMoving());
  EXPECT_EQ(drdStop(true), 0);
  EXPECT_FALSE(drdIsRunning());
  fake::pass(0, 0.001);
  EXPECT_TRUE(fake::f_sent_W(0).isZero(0)) << "its force must end too";
}

TEST_F(CompatDhd, RegulationMovesTheTipToAPoint) {
  begin_and_open({.held = false});
  EXPECT_EQ(drdMoveToPos(0, 0, 0, true), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NO_REGULATION);
  ASSERT_EQ(drdStart(), 0);
  wait_for(0.1);
  ASSERT_EQ(drdMoveToPos(0.03, -0.02, 0.01, true), 0);
  EXPECT_LT((tip() - Eigen::Vector3d(0.03, -0.02, 0.01)).norm(), 2e-3);
  EXPECT_FALSE(drdIsMoving());
  ASSERT_EQ(drdMoveToPos(0, 0, 0, false), 0);
  EXPECT_TRUE(drdIsMoving());
  ASSERT_EQ(drdHold(), 0);
  EXPECT_FALSE(drdIsMoving());
  EXPECT_EQ(drdMoveToPos(0.2, 0, 0, true), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_GEOMETRY);
  double goal[DHD_MAX_DOF] = {0.01, 0.01, 0.01, 0, 0, 0, 0, 0};
  ASSERT_EQ(drdMoveTo(goal, true), 0);
  EXPECT_LT((tip() - Eigen::Vector3d(0.01, 0.01, 0.01)).norm(), 2e-3);
}

TEST_F(CompatDhd, MovesInTheFrameOfTheProgram) {
  begin_and_open({.held = false});
  dhdSetBaseAngleZDeg(90);
  ASSERT_EQ(drdStart(), 0);
  wait_for(0.1);
  ASSERT_EQ(drdMoveToPos(0.03, 0, 0, true), 0);
  ArmReading reading;
  arms::read(0, reading);
  EXPECT_NEAR(reading.p_WT[1], -0.03, 2e-3);
}

TEST_F(CompatDhd, BlockedMotionTimesOut) {
  begin_and_open({.held = true});
  ASSERT_EQ(drdStart(), 0);
  EXPECT_EQ(drdMoveToPos(0.03, 0, 0, true), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_TIMEOUT);
  EXPECT_FALSE(drdIsMoving());
  EXPECT_LE(fake::f_sent_W(0).norm(), 5 + 1e-9);
}

TEST_F(CompatDhd, BlockedMotionsEndWithinTheirBounds) {
  begin_and_open({.held = true});
  ASSERT_EQ(drdStart(), 0);
  wait_for(0.05);
  const auto seconds = [](auto move) {
    ArmReading before, after;
    arms::read(0, before);
    EXPECT_EQ(move(), 0);
    while (drdIsMoving()) drdWaitForTick();
    arms::read(0, after);
    return 1e-9 * static_cast<double>(after.time_ns - before.time_ns);
  };
  ASSERT_EQ(drdSetPosMoveParam(100, 0.5, 1e6), 0);
  const double fast = seconds([] { return drdMoveToPos(0.05, 0, 0, false); });
  // Without an upper bound: the fake arms' time passes while this thread is not scheduled. A motion
  // that never ended would hang the test.
  constexpr double kEarly = 0.02;
  EXPECT_GT(fast, 1.875 * 0.05 / 0.5 + 0.8 - kEarly);
  ASSERT_EQ(drdHold(), 0);
  wait_for(0.05);
  ASSERT_EQ(drdSetPosTrackParam(100, 0.5, 1e6), 0);
  const double tracked = seconds([] { return drdTrackPos(0.05, 0, 0); });
  EXPECT_GT(tracked, 0.05 / 0.5 + 0.8 - kEarly);
}

TEST_F(CompatDhd, MotionRightAfterTheStartBeginsAtTheTip) {
  begin_and_open({.held = false});
  fake::change(0, [](ArmReading& now) { now.p_WT = {0.05, 0, 0}; });
  ASSERT_EQ(drdStart(), 0);
  ASSERT_EQ(drdMoveToPos(0.05, 0.001, 0, false), 0);
  double strongest = 0;
  while (drdIsMoving()) strongest = std::max(strongest, fake::f_sent_W(0).norm());
  EXPECT_LT(strongest, 0.5) << "N; a path from another point begins with a jerk";
}

TEST_F(CompatDhd, InitializationMovesASimulatedArmToTheMiddle) {
  begin_and_open({.held = false});
  fake::change(0, [](ArmReading& now) { now.p_WT = {0.04, -0.03, 0.02}; });
  ASSERT_EQ(drdAutoInit(), 0);
  EXPECT_LT(tip().norm(), 2e-3);
  EXPECT_TRUE(drdIsRunning()) << "the arm is held there";
  EXPECT_EQ(dhdSetForce(0, 0, 0.1), 0) << "a force of the program ends that";
  EXPECT_FALSE(drdIsRunning());
}

TEST_F(CompatDhd, InitializationDoesNotMoveARealArm) {
  begin_and_open({.held = false, .simulated = false});
  fake::change(0, [](ArmReading& now) { now.p_WT = {0.04, 0, 0}; });
  ASSERT_EQ(drdAutoInit(), 0);
  EXPECT_FALSE(drdIsRunning());
  EXPECT_FALSE(arms::force_enabled(0));
  EXPECT_EQ(tip().x(), 0.04);
}

TEST_F(CompatDhd, RegulationMarksTheArmAsMovedByTheProgram) {
  begin_and_open({.held = false});
  EXPECT_FALSE(fake::regulated(0));
  ASSERT_EQ(drdStart(), 0);
  wait_for(0.05);
  EXPECT_TRUE(fake::regulated(0));
  ASSERT_EQ(drdRegulatePos(false), 0);
  wait_for(0.05);
  EXPECT_FALSE(fake::regulated(0));
  ASSERT_EQ(drdRegulatePos(true), 0);
  wait_for(0.05);
  ASSERT_EQ(drdStop(true), 0);
  EXPECT_FALSE(fake::regulated(0));
}

TEST_F(CompatDhd, RegulationKeepsItsForceRatio) {
  begin_and_open({.held = true});
  ASSERT_EQ(drdSetMotRatioMax(0.1), 0);
  EXPECT_EQ(drdGetMotRatioMax(), 0.1);
  ASSERT_EQ(drdStart(), 0);
  ASSERT_EQ(drdMoveToPos(0.05, 0, 0, false), 0);
  wait_for(2);
  EXPECT_NEAR(fake::f_sent_W(0).norm(), 0.5, 1e-9);
  EXPECT_EQ(drdSetMotRatioMax(1.1), -1);
  EXPECT_EQ(drdSetMotRatioMax(std::nan("")), -1);
}

TEST_F(CompatDhd, GainsScaleTheForceOfRegulation) {
  begin_and_open({.held = true});
  EXPECT_EQ(drdGetEncPGain(), 1);
  EXPECT_EQ(drdGetEncDGain(), 1);
  EXPECT_EQ(drdGetEncIGain(), 0);
  ASSERT_EQ(drdStart(), 0);
  wait_for(0.05);
  ASSERT_EQ(drdMoveToPos(0.005, 0, 0, false), 0);
  const auto force = [](double gain) {
    EXPECT_EQ(drdSetEncPGain(gain), 0);
    EXPECT_EQ(drdGetEncPGain(), gain);
    wait_for(1);
    return fake::f_sent_W(0).x();
  };
  EXPECT_NEAR(force(1), 0.005 * 400, 1e-6) << "half of the declared stiffness";
  EXPECT_NEAR(force(0.5), 0.005 * 200, 1e-6);
  EXPECT_NEAR(force(2), 0.005 * 800, 1e-6);
  EXPECT_NEAR(force(1000), 0.005 * 800, 1e-6) << "never more than is declared";
  ASSERT_EQ(drdSetEncDGain(0.1), 0);
  EXPECT_NEAR(force(1000), 0.005 * 160, 1e-6) << "at most what the damping keeps stable";
  EXPECT_EQ(drdSetEncIGain(3), 0);
  EXPECT_EQ(drdGetEncIGain(), 3);
  EXPECT_EQ(drdSetEncPGain(-1), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_INVALID);
  ASSERT_EQ(drdClose(), 0);
  ASSERT_EQ(drdOpenID(0), 0);
  EXPECT_EQ(drdGetEncPGain(), 1) << "an opened arm has its own gains";
}

TEST_F(CompatDhd, OpeningResetsTheSettingsOfRegulation) {
  begin_and_open({});
  ASSERT_EQ(drdSetMotRatioMax(0.1), 0);
  ASSERT_EQ(drdRegulatePos(false), 0);
  ASSERT_EQ(drdEnableFilter(false), 0);
  ASSERT_EQ(drdSetPosMoveParam(3, 4, 5), 0);
  ASSERT_EQ(drdClose(), 0);
  ASSERT_EQ(drdOpenID(0), 0);
  double acceleration = 0, speed = 0, jerk = 0;
  ASSERT_EQ(drdGetPosMoveParam(&acceleration, &speed, &jerk), 0);
  EXPECT_NE(speed, 4);
  EXPECT_EQ(drdGetMotRatioMax(), 1);
  EXPECT_TRUE(drdIsFiltering());
  ASSERT_EQ(drdStart(), 0);
  EXPECT_EQ(drdMoveToPos(0, 0, 0, false), 0) << "the position is regulated again";
}

TEST_F(CompatDhd, BoundsOfMotionsWithoutMotorsAreStored) {
  begin_and_open({});
  using Set = int (*)(double, double, double, char);
  using Get = int (*)(double*, double*, double*, char);
  const std::pair<Set, Get> all[] = {
      {drdSetRotMoveParam, drdGetRotMoveParam},   {drdSetRotTrackParam, drdGetRotTrackParam},
      {drdSetGripMoveParam, drdGetGripMoveParam}, {drdSetGripTrackParam, drdGetGripTrackParam},
      {drdSetEncMoveParam, drdGetEncMoveParam},   {drdSetEncTrackParam, drdGetEncTrackParam}};
  double number = 1;
  for (const auto& [set, get] : all) {
    ASSERT_EQ(set(number, number + 1, number + 2, 0), 0);
    number += 3;
  }
  number = 1;
  for (const auto& [set, get] : all) {
    double acceleration = 0, speed = 0, jerk = 0;
    ASSERT_EQ(get(&acceleration, &speed, &jerk, 0), 0);
    EXPECT_EQ(acceleration, number);
    EXPECT_EQ(speed, number + 1);
    EXPECT_EQ(jerk, number + 2);
    number += 3;
  }
}

TEST_F(CompatDhd, ReleasedArmTakesTorquesOfTheWristsJoints) {
  begin_and_open({.held = true});
  ASSERT_EQ(drdStart(), 0);
  ASSERT_EQ(drdRegulatePos(false), 0);
  double force[DHD_MAX_DOF] = {1, 2, 0, 0.5, 0, 0, 3, 0};
  ASSERT_EQ(drdSetForceAndWristJointTorquesAndGripperForce(force), 0);
  wait_for(0.2);
  EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(1, 2, 0));
  EXPECT_EQ(fake::asked(0).torque_W[0], 0.5);
  EXPECT_EQ(fake::asked(0).gripper, 3);
}

TEST_F(CompatDhd, RegulationFollowsAPointWithinItsBounds) {
  begin_and_open({.held = false});
  ASSERT_EQ(drdStart(), 0);
  ASSERT_EQ(drdSetPosTrackParam(2, 0.1, 50), 0);
  wait_for(0.1);
  ASSERT_EQ(drdTrackPos(0.04, 0, 0), 0);
  double fastest = 0;
  ArmReading reading;
  arms::read(0, reading);
  const std::int64_t end = reading.time_ns + 2'000'000'000;
  while (arms::read(0, reading) && reading.time_ns < end) {
    fastest = std::max(fastest,
                       Eigen::Vector3d(reading.v_WT[0], reading.v_WT[1], reading.v_WT[2]).norm());
  }
  EXPECT_LT((tip() - Eigen::Vector3d(0.04, 0, 0)).norm(), 2e-3);
  EXPECT_LT(fastest, 0.13);
  EXPECT_FALSE(drdIsMoving());
  EXPECT_TRUE(drdIsFiltering());
  ASSERT_EQ(drdEnableFilter(false), 0);
  EXPECT_FALSE(drdIsFiltering());
  double acceleration, speed, jerk;
  ASSERT_EQ(drdGetPosTrackParam(&acceleration, &speed, &jerk), 0);
  EXPECT_EQ(speed, 0.1);
  EXPECT_EQ(drdSetPosMoveParam(1, 0, 1), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_INVALID);
}

TEST_F(CompatDhd, ReleasedArmGetsTheForceOfTheProgram) {
  begin_and_open({.held = true});
  ASSERT_EQ(drdStart(), 0);
  EXPECT_EQ(dhdSetForce(1, 0, 0), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_DEVICE_IN_USE);
  ASSERT_EQ(drdRegulatePos(false), 0);
  double force[DHD_MAX_DOF] = {1, 2, 0, 0, 0, 0, 0, 0};
  ASSERT_EQ(drdSetForceAndTorqueAndGripperForce(force), 0);
  wait_for(0.2);
  EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(1, 2, 0));
  EXPECT_EQ(dhdSetForce(0, 0, 3), 0);
  wait_for(0.05);
  EXPECT_EQ(fake::f_sent_W(0), Eigen::Vector3d(0, 0, 3));
  EXPECT_EQ(drdMoveToPos(0, 0, 0, false), -1) << "there is nothing that could move it";
  ASSERT_EQ(drdRegulatePos(true), 0);
  wait_for(0.05);
  EXPECT_LT(fake::f_sent_W(0).norm(), 1e-9) << "held where it is";
}

TEST_F(CompatDhd, RegulationEndsWithTheArm) {
  begin_and_open({.held = true});
  ASSERT_EQ(drdStart(), 0);
  ASSERT_EQ(drdClose(), 0);
  ASSERT_EQ(dhdOpenID(0), 0);
  EXPECT_FALSE(drdIsRunning()) << "an arm that is opened again at once is not regulated";
  fake::pass(0, 0.001);
  EXPECT_TRUE(fake::f_sent_W(0).isZero(0));
  begin_and_open({.held = true});
  dhdEnableForce(DHD_OFF);
  EXPECT_EQ(drdStart(), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NOT_ENABLED);
  dhdEnableForce(DHD_ON);
  ASSERT_EQ(drdStart(), 0);
  ASSERT_EQ(drdStop(false), 0);
  EXPECT_FALSE(arms::force_enabled(0));
  ASSERT_EQ(drdStart(), 0) << "what drdStop switched off, drdStart switches on";
  EXPECT_TRUE(arms::force_enabled(0));
}

TEST_F(CompatDhd, RegulationEndsWithTheRun) {
  begin_and_open({.held = true});
  ASSERT_EQ(drdStart(), 0);
  fake::end_run();
  while (drdIsRunning()) std::this_thread::yield();
  EXPECT_EQ(drdWaitForTick(), -1);
  EXPECT_EQ(dhdErrorGetLast(), DHD_ERROR_NO_REGULATION);
}

}  // namespace
}  // namespace thimble::compat
