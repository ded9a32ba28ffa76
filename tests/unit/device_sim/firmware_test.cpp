#include "board/firmware.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

#include "arm_table.h"
#include "arms/hfab/hfab_report.h"
#include "support/random.h"
#include "support/refuses.h"
#include "vintage_simulation.h"

namespace thimble::device_sim {
namespace {

using support::refuses;

SerialPose pose_at(const Eigen::Vector3d& q) {
  const auto model = support::vintage_model();
  return {model.geometry, model.geometry.forward(q)};
}

// Returns the home pose with each joint moved by the given number of encoder steps.
SerialPose steps_from_home(double a, double b, double c) {
  const auto model = support::vintage_model();
  Eigen::Vector3d q = support::vintage_home();
  const Eigen::Vector3d counts(a, b, c);
  for (int i = 0; i < 3; ++i) {
    const auto joint = static_cast<std::size_t>(i);
    q[i] += model.encoders[joint].sign * counts[i] * model.step(joint);
  }
  return pose_at(q);
}

driver::hfab::InputReport sampled(const Firmware& firmware, const SerialPose& pose) {
  return driver::hfab::decode_input(firmware.sample(pose.angles())).value();
}

TEST(Firmware, CountsFromZeroAtHomeAndRoundsToTheNearestStep) {
  const Firmware firmware = Firmware::make(arm_model(support::vintage_model()), {}).value();
  EXPECT_EQ(sampled(firmware, steps_from_home(0, 0, 0)), driver::hfab::InputReport{});
  const auto report = sampled(firmware, steps_from_home(100.4, -7.6, 2000.1));
  EXPECT_EQ(report.counts, (std::array<std::int16_t, 6>{100, -8, 2000, 0, 0, 0}));
}

TEST(Firmware, OneCountMovesTheTipAsGeometryPredicts) {
  // 0.024, 0.028 and 0.023 mm per count at home [DEVICES 2].
  const auto model = support::vintage_model();
  const driver::hfab::HfabArm arm(model);
  const double expected[] = {0.138 * 2 * std::numbers::pi / 36000,
                             0.138 * 2 * std::numbers::pi / 30800,
                             0.112 * 2 * std::numbers::pi / 30800};
  const double published[] = {0.024e-3, 0.028e-3, 0.023e-3};
  const Firmware firmware = Firmware::make(arm_model(model), {}).value();
  for (int joint = 0; joint < 3; ++joint) {
    const auto tip = [&](double steps) {
      Eigen::Vector3d counts(0, 0, 0);
      counts[joint] = steps;
      driver::ArmReading reading;
      EXPECT_TRUE(arm.decode(
          firmware.sample(steps_from_home(counts[0], counts[1], counts[2]).angles()), reading));
      return arm.pose(reading).p_BT;
    };
    EXPECT_EQ(tip(0.49), tip(-0.49));
    const double step = (tip(0.51) - tip(0.49)).norm();
    EXPECT_NEAR(step, expected[joint], 1e-8);
    EXPECT_NEAR(step, published[joint], 0.0005e-3);
  }
}

TEST(Firmware, IdealEncodersResolveOneNanometre) {
  const auto model = support::vintage_model();
  const auto arm = driver::make_ideal_arm(arm_model(model));
  FirmwareSettings ideal;
  ideal.ideal_encoders = true;
  const Firmware firmware = Firmware::make(arm_model(model), ideal).value();
  support::Random random(10);
  for (int i = 0; i < 2000; ++i) {
    const Eigen::Vector3d p_BT = home_tip() + random.in_box(0.05);
    const SerialPose pose(model.geometry, p_BT);
    if (!pose.within_reach()) continue;  // a few, in a corner of the box
    driver::ArmReading reading;
    ASSERT_TRUE(arm->decode(firmware.sample(pose.angles()), reading));
    ASSERT_LT((arm->pose(reading).p_BT - p_BT).norm(), 1e-9) << p_BT.transpose();
  }
}

TEST(Firmware, WrapsItsCountersAtSixteenBits) {
  Firmware firmware = Firmware::make(arm_model(support::vintage_model()), {}).value();
  const SerialPose home = steps_from_home(0, 0, 0);
  firmware.preset(
      firmware
          .receive(driver::hfab::encode_output(
                       {.current_mA = {}, .command = 1, .attributes = {32767, -32768, 5}}),
                   0)
          .value(),
      home.angles());
  EXPECT_EQ(sampled(firmware, home).counts,
            (std::array<std::int16_t, 6>{32767, -32768, 5, 0, 0, 0}));
  EXPECT_EQ(sampled(firmware, steps_from_home(1, -1, 0)).counts,
            (std::array<std::int16_t, 6>{-32768, 32767, 5, 0, 0, 0}));
}

TEST(Firmware, SamplesAnglesOnlyFromReliableCounts) {
  FirmwareSettings ideal;
  ideal.ideal_encoders = true;
  for (const FirmwareSettings& settings : {FirmwareSettings(), ideal}) {
    const Firmware firmware = Firmware::make(arm_model(support::vintage_model()), settings).value();
    constexpr double kError = 1e-12;
    support::Random random(10);
    int sure = 0, unsure = 0;
    for (int i = 0; i < 20000; ++i) {
      // Every second position is within 0.002 of an edge between two counts of the first joint.
      const double near_edge =
          std::floor(random.uniform(-500, 500)) + 0.5 + random.in_box(0.002).x();
      const Eigen::Vector3d steps(i % 2 == 0 ? random.uniform(-500, 500) : near_edge, 300.2, -20.7);
      const Eigen::Vector3d q = steps_from_home(steps[0], steps[1], steps[2]).angles();
      const Eigen::Vector3d about = q + random.in_box(kError);
      BoardBytes bytes{};
      if (!firmware.sample_about(about, kError, {0, 0, 0}, 0, bytes)) {
        EXPECT_EQ(bytes.size, 0u);
        ++unsure;
        continue;
      }
      ++sure;
      ASSERT_EQ(driver::hfab::decode_input(bytes), driver::hfab::decode_input(firmware.sample(q)));
    }
    EXPECT_GT(sure, 10000);
    EXPECT_GT(unsure, 20);
  }
}

TEST(Firmware, RestartCountsFromZeroWithMotorsOff) {
  Firmware firmware = Firmware::make(arm_model(support::vintage_model()), {}).value();
  const SerialPose pose = steps_from_home(1500, 800, -300);
  firmware.receive(drive_message(100, 200, 300), 0);
  EXPECT_TRUE(firmware.motors_on());
  firmware.restart(pose.angles());
  EXPECT_FALSE(firmware.motors_on());
  EXPECT_EQ(firmware.currents(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(sampled(firmware, pose), driver::hfab::InputReport{});
  EXPECT_EQ(sampled(firmware, steps_from_home(0, 0, 0)).counts,
            (std::array<std::int16_t, 6>{-1500, -800, 300, 0, 0, 0}));
}

TEST(Firmware, HomingPresetsCountersWithoutCurrent) {
  Firmware firmware = Firmware::make(arm_model(support::vintage_model()), {}).value();
  const SerialPose pose = steps_from_home(10.3, 20.3, 30.3);
  firmware.receive(drive_message(100, 200, 300), 0);
  firmware.press_button();
  EXPECT_EQ(sampled(firmware, pose).info, 1);
  firmware.preset(
      firmware
          .receive(driver::hfab::encode_output(
                       {.current_mA = {7, 8, 9}, .command = 1, .attributes = {1, 2, 3}}),
                   1)
          .value(),
      pose.angles());
  const auto report = sampled(firmware, pose);
  EXPECT_EQ(report.counts, (std::array<std::int16_t, 6>{1, 2, 3, 7, 8, 9}));
  EXPECT_EQ(report.info, 0);
  EXPECT_EQ(firmware.currents(), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(firmware.counters().presets, 1U);
  // The encoder discs did not move: the next edge is still 0.2 of a step away.
  EXPECT_EQ(sampled(firmware, steps_from_home(10.45, 20.45, 30.45)).counts[0], 1);
  EXPECT_EQ(sampled(firmware, steps_from_home(10.55, 20.55, 30.55)).counts[0], 2);
}

TEST(Firmware, WiringSelectsEncodersAndMotors) {
  FirmwareSettings settings;
  settings.wiring.encoder_of = {1, 0, 2};
  settings.wiring.encoder_gain = {1, -1, 0};
  settings.wiring.motor_of = {0, 2, 1};
  settings.wiring.motor_gain = {0, -1, 1};
  Firmware firmware = Firmware::make(arm_model(support::vintage_model()), settings).value();
  EXPECT_EQ(sampled(firmware, steps_from_home(100, 200, 300)).counts,
            (std::array<std::int16_t, 6>{200, -100, 0, 0, 0, 0}));
  firmware.receive(drive_message(1000, 2000, 3000), 0);
  EXPECT_EQ(firmware.currents(), Eigen::Vector3d(0, 3, -2));
  settings.wiring.motor_of = {0, 3, 1};
  EXPECT_TRUE(
      refuses(Firmware::make(arm_model(support::vintage_model()), settings), "unknown joint"));
}

TEST(Firmware, TakesACurrentBeyondItsRangeAsZero) {
  FirmwareSettings settings;
  settings.current_range_mA = 3000;
  Firmware firmware = Firmware::make(arm_model(support::vintage_model()), settings).value();
  firmware.receive(drive_message(3000, 3001, -3000), 0);
  EXPECT_EQ(firmware.currents(), Eigen::Vector3d(3, 0, -3));
  EXPECT_EQ(firmware.counters().over_range, 1U);
  firmware.receive(drive_message(-32768, 1, 32767), 0);
  EXPECT_EQ(firmware.currents(), Eigen::Vector3d(0, 0.001, 0));
  EXPECT_EQ(firmware.counters().over_range, 3U);
}

TEST(Firmware, IgnoresAndCountsMessagesOfUnknownLength) {
  Firmware firmware = Firmware::make(arm_model(support::vintage_model()), {}).value();
  firmware.receive(drive_message(100, 0, 0), 0);
  const std::array<std::byte, 65> bytes{};
  std::uint64_t malformed = 0;
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    if (size == driver::hfab::kReportSize || size == driver::hfab::kPaddedReportSize) continue;
    firmware.receive(std::span<const std::byte>(bytes).first(size), 50'000'000);
    ++malformed;
  }
  EXPECT_EQ(firmware.counters().malformed, malformed);
  EXPECT_EQ(firmware.currents().x(), 0.1);
  // A message that is not understood does not keep the motors on either.
  EXPECT_EQ(firmware.watchdog_due_ns(), 100'000'000);
}

TEST(Firmware, FirstMessageArmsTheWatchdog) {
  Firmware firmware = Firmware::make(arm_model(support::vintage_model()), {}).value();
  EXPECT_FALSE(firmware.motors_on());
  EXPECT_EQ(firmware.watchdog_due_ns(), Firmware::kNever_ns);
  firmware.watch(1'000'000'000'000);
  EXPECT_EQ(firmware.counters().watchdog_fired, 0U);
  firmware.receive(drive_message(500, 0, 0), 7);
  EXPECT_TRUE(firmware.motors_on());
  firmware.watch(100'000'006);
  EXPECT_EQ(firmware.currents().x(), 0.5);
  firmware.watch(100'000'007);
  EXPECT_EQ(firmware.currents().x(), 0);
  EXPECT_FALSE(firmware.motors_on());
  EXPECT_EQ(firmware.counters().watchdog_fired, 1U);
}

TEST(Firmware, RefusesSettingsThatCannotWork) {
  FirmwareSettings settings;
  settings.report_period_ns = 0;
  EXPECT_TRUE(
      refuses(Firmware::make(arm_model(support::vintage_model()), settings), "report period"));
  settings = {};
  settings.watchdog_ns = 0;
  EXPECT_TRUE(refuses(Firmware::make(arm_model(support::vintage_model()), settings), "watchdog"));
  settings = {};
  settings.current_range_mA = -1;
  EXPECT_TRUE(
      refuses(Firmware::make(arm_model(support::vintage_model()), settings), "current range"));
  auto model = support::vintage_model();
  model.encoders[1].counts_per_motor_turn = 0;
  EXPECT_TRUE(refuses(Firmware::make(arm_model(model), {}), "encoders need counts"));
}

}  // namespace
}  // namespace thimble::device_sim
