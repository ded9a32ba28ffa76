#include "simulated_arm.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "arms/hfab/hfab_report.h"
#include "support/random.h"
#include "support/refuses.h"
#include "vintage_simulation.h"

namespace thimble::device_sim {
namespace {

using support::refuses;

constexpr std::int64_t kMillisecond = 1'000'000;

SimulatedArm free_at_home(const SimulatedArmSettings& settings) {
  return SimulatedArm::make(support::vintage_model(), settings, resting_at(home_tip())).value();
}

TEST(SimulatedArm, BeginsAtRestWithAReportAtTimeZero) {
  SimulatedArm arm = free_at_home(phantom_like());
  EXPECT_EQ(arm.time_ns(), 0);
  EXPECT_EQ(arm.next_report_ns(), 0);
  EXPECT_EQ(arm.plant().v_BT(), Eigen::Vector3d(0, 0, 0));
  const auto report = take(arm);
  ASSERT_TRUE(report.has_value());
  EXPECT_EQ(*report, driver::hfab::InputReport{});
  EXPECT_FALSE(take(arm).has_value());
  EXPECT_EQ(arm.next_report_ns(), kMillisecond);
}

TEST(SimulatedArm, StaysAtRestInAStillHand) {
  SimulatedArm arm = free_at_home(phantom_like());
  arm.advance_to(1000 * kMillisecond);
  EXPECT_EQ(arm.plant().p_BT(), home_tip());
  EXPECT_EQ(arm.plant().v_BT(), Eigen::Vector3d(0, 0, 0));
}

TEST(SimulatedArm, DropsOldReportsInFavourOfTheNewestAndCountsThem) {
  SimulatedArm arm = free_at_home(phantom_like());
  arm.advance_to(1000 * kMillisecond);
  std::array<std::byte, driver::kReportCapacity> buffer;
  std::uint32_t skipped = 0;
  EXPECT_EQ(arm.take_report(buffer, skipped), driver::hfab::kReportSize);
  EXPECT_EQ(skipped, 1000U);
  EXPECT_EQ(arm.take_report(buffer, skipped), 0U);
  EXPECT_EQ(skipped, 0U);
}

TEST(SimulatedArm, CutsAReportThatDoesNotFit) {
  SimulatedArm arm = free_at_home(phantom_like());
  std::array<std::byte, 5> buffer;
  std::uint32_t skipped = 0;
  EXPECT_EQ(arm.take_report(buffer, skipped), buffer.size());
}

TEST(SimulatedArm, DeliversAReportExactlyAfterItsDelay) {
  SimulatedArmSettings settings = free_arm();
  settings.wire.delay_in_ns = 2'345'678;
  SimulatedArm arm = free_at_home(settings);
  EXPECT_EQ(arm.next_report_ns(), 2'345'678);
  arm.advance_to(2'345'677);
  EXPECT_FALSE(take(arm).has_value());
  arm.advance_to(2'345'678);
  EXPECT_TRUE(take(arm).has_value());
  EXPECT_EQ(arm.next_report_ns(), 3'345'678);
}

TEST(SimulatedArm, ReportHoldsTheStateOfItsSampleTime) {
  SimulatedArmSettings settings = free_arm();
  settings.wire.delay_in_ns = 5 * kMillisecond / 2;
  SimulatedArm late = free_at_home(settings);
  settings.wire.delay_in_ns = 0;
  SimulatedArm prompt = free_at_home(settings);
  const auto push = drive_message(500, 0, 0);
  late.put_message(push);
  prompt.put_message(push);
  for (int k = 0; k <= 40; ++k) {
    prompt.advance_to(k * kMillisecond);
    late.advance_to(k * kMillisecond + 5 * kMillisecond / 2);
    const auto now = take(prompt), then = take(late);
    ASSERT_TRUE(now && then);
    ASSERT_EQ(*now, *then);
  }
  EXPECT_GT((prompt.plant().p_BT() - home_tip()).norm(), 1e-3);
}

TEST(SimulatedArm, MessageActsExactlyAfterItsDelay) {
  SimulatedArmSettings settings = free_arm();
  settings.wire.delay_out_ns = 1'234'567;
  SimulatedArm arm = free_at_home(settings);
  arm.advance_to(1000);
  arm.put_message(drive_message(1000, 0, 0));
  arm.advance_to(1'235'566);
  EXPECT_EQ(arm.plant().currents().x(), 0);
  arm.advance_to(1'235'567);
  EXPECT_EQ(arm.plant().currents().x(), 1);
  EXPECT_EQ(arm.plant().v_BT(), Eigen::Vector3d(0, 0, 0));
  arm.advance_to(1'235'568);
  EXPECT_NE(arm.plant().v_BT(), Eigen::Vector3d(0, 0, 0));
}

TEST(SimulatedArm, KeepsMessagesInOrderOnTheWire) {
  SimulatedArmSettings settings = free_arm();
  settings.wire.delay_out_ns = 10 * kMillisecond;
  SimulatedArm arm = free_at_home(settings);
  for (std::int16_t k = 0; k < 10; ++k) {
    arm.advance_to(k * 100'000);
    arm.put_message(drive_message(static_cast<std::int16_t>(k + 1), 0, 0));
  }
  for (int k = 0; k < 10; ++k) {
    arm.advance_to(10 * kMillisecond + k * 100'000);
    EXPECT_EQ(arm.plant().currents().x(), (k + 1) * 1e-3);
  }
}

TEST(SimulatedArm, WatchdogActsAtTheExactNanosecond) {
  SimulatedArm arm = free_at_home(phantom_like());
  arm.advance_to(123'456);
  arm.put_message(drive_message(300, 0, 0));
  arm.advance_to(100'123'455);
  EXPECT_EQ(arm.plant().currents().x(), 0.3);
  arm.advance_to(100'123'456);
  EXPECT_EQ(arm.plant().currents().x(), 0);
  EXPECT_EQ(arm.firmware().counters().watchdog_fired, 1U);
  // The next message switches them on again.
  arm.put_message(drive_message(200, 0, 0));
  EXPECT_EQ(arm.plant().currents().x(), 0.2);
}

TEST(SimulatedArm, KeepsItsMotorsOnWhenAMessageComesJustInTime) {
  SimulatedArmSettings settings = phantom_like();
  settings.wire.delay_out_ns = 500;
  SimulatedArm arm = free_at_home(settings);
  arm.put_message(drive_message(300, 0, 0));
  arm.advance_to(100 * kMillisecond);
  arm.put_message(drive_message(400, 0, 0));
  arm.advance_to(100 * kMillisecond + 500);
  EXPECT_EQ(arm.plant().currents().x(), 0.4);
  EXPECT_EQ(arm.firmware().counters().watchdog_fired, 0U);
  arm.advance_to(150 * kMillisecond);
  EXPECT_EQ(arm.plant().currents().x(), 0.4);
}

TEST(SimulatedArm, SamplesBeforeAMessageOfTheSameMoment) {
  SimulatedArmSettings settings = phantom_like();
  settings.wire.delay_out_ns = kMillisecond;
  SimulatedArm arm = free_at_home(settings);
  arm.put_message(
      driver::hfab::encode_output({.current_mA = {}, .command = 1, .attributes = {42, 0, 0}}));
  arm.advance_to(kMillisecond);
  EXPECT_EQ(take(arm)->counts[0], 0);
  arm.advance_to(2 * kMillisecond);
  EXPECT_EQ(take(arm)->counts[0], 42);
}

TEST(SimulatedArm, IsAnIdealZeroOrderHoldWithoutDelay) {
  // The reference: the same plant, driven directly by the host's law without a wire.
  auto model = support::vintage_model();
  SimulatedArmSettings settings = phantom_like();
  SimulatedArm arm = SimulatedArm::make(model, settings, resting_at(home_tip())).value();
  ArmPlant plant = ArmPlant::make(model.geometry, model.drives, settings.plant, settings.hand,
                                  settings.motors, home_tip(), home_tip())
                       .value();
  const Firmware board = Firmware::make(arm_model(model), settings.firmware).value();
  const auto law = [](const driver::hfab::InputReport& report, int k) {
    const auto kick = static_cast<std::int16_t>(k < 20 ? 900 : 0);
    return drive_message(static_cast<std::int16_t>(kick - report.counts[0] / 2), 0, 0);
  };
  for (int k = 0; k < 500; ++k) {
    arm.advance_to(k * kMillisecond);
    const auto report = take(arm);
    ASSERT_TRUE(report.has_value());
    arm.put_message(law(*report, k));

    const auto direct = driver::hfab::decode_input(board.sample(plant.q())).value();
    ASSERT_EQ(*report, direct) << k;
    const auto message = driver::hfab::decode_output(law(direct, k)).value();
    plant.set_currents({message.current_mA[0] * 1e-3, 0, 0});
    ASSERT_EQ(arm.plant().p_BT(), plant.p_BT()) << k;
    plant.step(home_tip(), kMillisecond);
  }
  EXPECT_NE(plant.p_BT(), home_tip());
}

TEST(SimulatedArm, FollowsTheHandAlongItsPath) {
  SimulatedArmSettings settings = phantom_like();
  const Eigen::Vector3d there = home_tip() + Eigen::Vector3d(0.02, -0.01, 0.015);
  SimulatedArm arm = SimulatedArm::make(support::vintage_model(), settings,
                                        HandPath::make({{0.1, home_tip()}, {0.6, there}}).value())
                         .value();
  arm.advance_to(350 * kMillisecond);
  EXPECT_LT((arm.p_BH() - 0.5 * (home_tip() + there)).norm(), 1e-12);
  arm.advance_to(2000 * kMillisecond);
  EXPECT_EQ(arm.p_BH(), there);
  // With dry friction, each axis rests at most c/k away.
  EXPECT_LE((arm.plant().p_BT() - there).cwiseAbs().maxCoeff(), 0.04 / 300 + 1e-9);
}

TEST(SimulatedArm, IsIndependentOfTheStepsOfAdvance) {
  const HandPath path =
      HandPath::make({{0.0, home_tip()}, {1.0, home_tip() + Eigen::Vector3d(0.03, 0.02, 0)}})
          .value();
  SimulatedArm whole = SimulatedArm::make(support::vintage_model(), phantom_like(), path).value();
  SimulatedArm pieces = SimulatedArm::make(support::vintage_model(), phantom_like(), path).value();
  support::Random random(11);
  whole.advance_to(900 * kMillisecond);
  std::int64_t time_ns = 0;
  while (time_ns < 900 * kMillisecond) {
    time_ns += static_cast<std::int64_t>(random.uniform(1, 3e6));
    pieces.advance_to(std::min(time_ns, 900 * kMillisecond));
  }
  EXPECT_LT((whole.plant().p_BT() - pieces.plant().p_BT()).norm(), 1e-12);
  EXPECT_LT((whole.plant().v_BT() - pieces.plant().v_BT()).norm(), 1e-10);
}

TEST(SimulatedArm, DoesNothingForATimeInThePast) {
  SimulatedArm arm = free_at_home(phantom_like());
  arm.advance_to(5 * kMillisecond);
  arm.advance_to(kMillisecond);
  EXPECT_EQ(arm.time_ns(), 5 * kMillisecond);
}

// Returns the values of an arm during a second with many events, to compare runs.
std::vector<double> trace(std::uint64_t seed, double tremor) {
  SimulatedArmSettings settings = phantom_like();
  settings.hand.tremor_amplitude = tremor;
  settings.wire = {.delay_in_ns = 300'000, .delay_out_ns = 700'001};
  SimulatedArm arm =
      SimulatedArm::make(
          support::vintage_model(), settings,
          HandPath::make({{0.0, home_tip()}, {0.5, home_tip() + Eigen::Vector3d(0.02, 0, 0)}})
              .value(),
          seed)
          .value();
  std::vector<double> values;
  for (int k = 0; k < 1000; ++k) {
    arm.advance_to(k * kMillisecond);
    if (const auto report = take(arm)) {
      arm.put_message(drive_message(report->counts[0], report->counts[1], report->counts[2]));
      values.push_back(report->counts[0]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      values.push_back(arm.plant().p_BT()[axis]);
      values.push_back(arm.plant().v_BT()[axis]);
    }
  }
  return values;
}

TEST(SimulatedArm, RepeatedRunIsBitIdentical) {
  EXPECT_EQ(trace(1, 300e-6), trace(1, 300e-6));
  EXPECT_NE(trace(1, 300e-6), trace(2, 300e-6));
  EXPECT_EQ(trace(1, 0), trace(2, 0));
}

TEST(SimulatedArm, ShowsItsButtonUntilAPreset) {
  SimulatedArm arm = free_at_home(phantom_like());
  arm.press_button();
  arm.advance_to(kMillisecond);
  EXPECT_EQ(take(arm)->info, 1);
  arm.advance_to(2 * kMillisecond);
  EXPECT_EQ(take(arm)->info, 1);
  arm.put_message(driver::hfab::encode_output({.current_mA = {}, .command = 1, .attributes = {}}));
  arm.advance_to(3 * kMillisecond);
  EXPECT_EQ(take(arm)->info, 0);
}

TEST(SimulatedArm, FullWireDropsTheOldestMessage) {
  SimulatedArmSettings settings = phantom_like();
  settings.wire.delay_out_ns = kMillisecond;
  SimulatedArm arm = free_at_home(settings);
  for (int k = 0; k < 300; ++k) arm.put_message(drive_message(static_cast<std::int16_t>(k), 0, 0));
  EXPECT_EQ(arm.wire_overflows(), 300 - WireQueue::kFrames);
  arm.advance_to(kMillisecond);
  EXPECT_EQ(arm.firmware().counters().messages, WireQueue::kFrames);
  EXPECT_EQ(arm.plant().currents().x(), 0.299);
}

TEST(SimulatedArm, IgnoresMessagesThatAreTooLong) {
  SimulatedArmSettings settings = phantom_like();
  for (const std::int64_t delay_ns : {std::int64_t{0}, kMillisecond}) {
    settings.wire.delay_out_ns = delay_ns;
    SimulatedArm arm = free_at_home(settings);
    const std::array<std::byte, 200> bytes{};
    arm.put_message(bytes);
    arm.advance_to(kMillisecond);
    EXPECT_EQ(arm.firmware().counters().malformed, 1U);
    EXPECT_EQ(arm.firmware().counters().messages, 0U);
  }
}

TEST(SimulatedArm, RefusesInvalidSettingsOfItsParts) {
  const auto made = [](const SimulatedArmSettings& settings) {
    return SimulatedArm::make(support::vintage_model(), settings, resting_at(home_tip()));
  };
  SimulatedArmSettings settings = phantom_like();
  settings.hand.tremor_amplitude = -1;
  EXPECT_TRUE(refuses(made(settings), "tremor amplitude"));
  settings = phantom_like();
  settings.plant.mass = -1;
  EXPECT_TRUE(refuses(made(settings), "tip mass"));
  settings = phantom_like();
  settings.firmware.watchdog_ns = 0;
  EXPECT_TRUE(refuses(made(settings), "watchdog"));
  EXPECT_TRUE(made(phantom_like()));
}

TEST(SimulatedArm, RefusesNegativeDelays) {
  SimulatedArmSettings settings = phantom_like();
  settings.wire.delay_in_ns = -1;
  EXPECT_TRUE(refuses(
      SimulatedArm::make(support::vintage_model(), settings, resting_at(home_tip())), "delays"));
}

}  // namespace
}  // namespace thimble::device_sim
