#include "firmware/core/controller.h"

#include <gtest/gtest.h>

#include <limits>

#include "messages.h"

namespace thimble::firmware::test {
namespace {

constexpr std::uint32_t kPeriod_us = 1000;

ArmConfig limited_arm() {
  ArmConfig config;
  config.current_max_mA = 2000;
  config.supply_min_mV = 9000;
  return config;
}

/// A controller with a clock and healthy inputs.
class Bench {
 public:
  explicit Bench(const ArmConfig& config = limited_arm(), std::uint32_t time_us = 0,
                 bool restarted = false)
      : controller(config, restarted), now_us(time_us) {
    inputs.supply_mV = 24000;
    inputs.temperature_dC = 250;
    tick();
  }

  void tick() {
    controller.tick(inputs, now_us);
    now_us += kPeriod_us;
  }
  bool send(const Message& bytes) { return controller.receive(bytes.data(), bytes.size(), now_us); }
  /// Enables the motors, and requests currents.
  void start(float a = 1, float b = 0, float c = 0) {
    send(drive(0, 0, 0));
    send(drive(a, b, c));
  }
  /// Returns the bytes of the next state.
  std::array<std::uint8_t, kStateSize> state() {
    std::array<std::uint8_t, kStateSize> bytes{};
    controller.report(bytes.data());
    return bytes;
  }
  bool off() const {
    const Outputs& outputs = controller.outputs();
    return !outputs.motors_on && outputs.amperes[0] == 0 && outputs.amperes[1] == 0 &&
           outputs.amperes[2] == 0;
  }
  /// Ticks with fresh drive messages, at most `ticks` times, until a fault.
  void drive_until_fault(int ticks) {
    for (int i = 0; i < ticks && controller.stage() == Stage::kDriving; ++i) {
      send(drive(1, 0, 0));
      tick();
    }
  }

  Controller controller;
  Inputs inputs;
  std::uint32_t now_us;
};

TEST(FirmwareController, MotorsAreOffAfterAReset) {
  Bench bench;
  EXPECT_TRUE(bench.off());
  EXPECT_EQ(bench.controller.stage(), Stage::kOff);
}

TEST(FirmwareController, IgnoresCurrentsUntilAValidZero) {
  Bench bench;
  bench.send(drive(1, 0, 0));
  EXPECT_TRUE(bench.off());
  bench.send(drive(0, 0, 0));
  bench.send(drive(1, -2, 0.5f));
  EXPECT_TRUE(bench.controller.outputs().motors_on);
  EXPECT_EQ(bench.controller.outputs().amperes[1], -2);
}

TEST(FirmwareController, DrivesOnlyAfterTheFirstSample) {
  Controller controller(limited_arm());
  const Message zero = drive(0, 0, 0);
  controller.receive(zero.data(), zero.size(), 0);
  EXPECT_EQ(controller.stage(), Stage::kOff);
}

TEST(FirmwareController, WatchdogSwitchesOffAfter50ms) {
  Bench bench;
  bench.start();
  const std::uint32_t fed_us = bench.now_us;
  bench.controller.watch(fed_us + 49'999);
  EXPECT_FALSE(bench.off());
  bench.controller.watch(fed_us + 50'000);
  EXPECT_TRUE(bench.off());
  EXPECT_EQ(bench.controller.flags(), kWatchdog);
}

TEST(FirmwareController, WatchdogCountsOverTheWrapOfTime) {
  Bench bench(limited_arm(), 0xffffffffu - 20'000);
  bench.start();
  const std::uint32_t fed_us = bench.now_us;
  bench.controller.watch(fed_us + 49'999);
  EXPECT_FALSE(bench.off());
  bench.controller.watch(fed_us + 50'000);
  EXPECT_TRUE(bench.off());
}

TEST(FirmwareController, TimeFromBeforeTheLastMessageIsNoSilence) {
  Bench bench;
  bench.start();
  bench.controller.watch(bench.now_us - 100);
  EXPECT_FALSE(bench.off());
}

TEST(FirmwareController, RefusedMessagesDoNotFeedTheWatchdog) {
  Bench bench;
  bench.start();
  Message torn = drive(1, 0, 0);
  torn.back() ^= 1;
  for (int i = 0; i < 60; ++i) {
    bench.send(torn);
    bench.tick();
  }
  EXPECT_EQ(bench.controller.flags(), kWatchdog);
  EXPECT_EQ(get<std::uint16_t>(bench.state().data() + 42), 60);
}

TEST(FirmwareController, OtherMessagesDoNotFeedTheWatchdog) {
  Bench bench;
  bench.start();
  for (int i = 0; i < 60; ++i) {
    bench.send(message(kDescribe));
    bench.tick();
  }
  EXPECT_EQ(bench.controller.flags(), kWatchdog);
}

TEST(FirmwareController, FaultIsLatchedUntilClearAndAZero) {
  Bench bench;
  bench.start();
  bench.now_us += 50'000;
  bench.controller.watch(bench.now_us);
  bench.send(drive(0, 0, 0));
  bench.send(drive(1, 0, 0));
  bench.send(message(kStop));
  bench.send(drive(1, 0, 0));
  bench.tick();
  EXPECT_EQ(bench.controller.stage(), Stage::kFault);
  EXPECT_TRUE(bench.off());
  bench.send(message(kClear));
  EXPECT_EQ(bench.controller.stage(), Stage::kOff);
  EXPECT_EQ(bench.controller.flags(), 0);
  bench.send(drive(1, 0, 0));
  EXPECT_TRUE(bench.off());
  bench.start();
  EXPECT_FALSE(bench.off());
}

struct Cause {
  const char* name;
  std::uint16_t flag;
  void (*begin)(Bench&);
};

class FirmwareFault : public testing::TestWithParam<Cause> {};

TEST_P(FirmwareFault, SwitchesOffAndIsLatchedByName) {
  Bench bench;
  bench.start();
  const Inputs healthy = bench.inputs;
  GetParam().begin(bench);
  bench.drive_until_fault(20);
  EXPECT_TRUE(bench.off());
  EXPECT_EQ(bench.controller.flags(), GetParam().flag);
  bench.inputs.supply_mV = healthy.supply_mV;
  bench.inputs.temperature_dC = healthy.temperature_dC;
  bench.inputs.encoder_error = false;
  for (int i = 0; i < 20; ++i) bench.tick();
  EXPECT_EQ(get<std::uint16_t>(bench.state().data() + 20), GetParam().flag);
  bench.send(message(kClear));
  EXPECT_EQ(bench.controller.flags(), 0);
}

INSTANTIATE_TEST_SUITE_P(
    All, FirmwareFault,
    testing::Values(
        Cause{"over_speed", kOverSpeed, [](Bench& bench) { bench.inputs.counts[1] += 2000; }},
        Cause{"over_temperature", kOverTemperature,
              [](Bench& bench) { bench.inputs.temperature_dC = 801; }},
        Cause{"brown_out", kBrownOut, [](Bench& bench) { bench.inputs.supply_mV = 8999; }},
        Cause{"encoder", kEncoder, [](Bench& bench) { bench.inputs.encoder_error = true; }},
        Cause{"late_loop", kLateLoop, [](Bench& bench) { bench.now_us += 4 * kPeriod_us + 1; }},
        Cause{"link_lost", kLinkLost, [](Bench& bench) { bench.controller.lose_link(); }},
        Cause{"bad_command", kBadCommand, [](Bench& bench) { bench.send(drive(2.1f, 0, 0)); }}),
    [](const auto& tested) { return tested.param.name; });

TEST(FirmwareController, LostLinkIsNoFaultWhileTheMotorsAreOff) {
  Bench bench;
  bench.controller.lose_link();
  EXPECT_EQ(bench.controller.flags(), 0);
  bench.start();
  EXPECT_FALSE(bench.off());
}

TEST(FirmwareController, FaultStaysWhileItsCauseLasts) {
  Bench bench;
  bench.start();
  bench.inputs.temperature_dC = 900;
  bench.tick();
  bench.send(message(kClear));
  EXPECT_EQ(bench.controller.stage(), Stage::kFault);
  bench.inputs.temperature_dC = 250;
  bench.tick();
  bench.send(message(kClear));
  EXPECT_EQ(bench.controller.stage(), Stage::kOff);
}

TEST(FirmwareController, CauseBeforeTheStartPreventsDriving) {
  Bench bench;
  bench.inputs.supply_mV = 5000;
  bench.tick();
  bench.start();
  EXPECT_TRUE(bench.off());
  EXPECT_EQ(bench.controller.flags(), kBrownOut);
  bench.inputs.supply_mV = 24000;
  bench.tick();
  bench.start();
  EXPECT_FALSE(bench.off());
}

TEST(FirmwareController, NotFiniteCurrentsAreABadCommand) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(),
        -std::numeric_limits<float>::infinity()}) {
    Bench bench;
    bench.start();
    bench.send(drive(0, 0, bad));
    EXPECT_TRUE(bench.off());
    EXPECT_EQ(bench.controller.flags(), kBadCommand);
  }
}

TEST(FirmwareController, NanIsNoZero) {
  Bench bench;
  bench.send(drive(0, std::numeric_limits<float>::quiet_NaN(), 0));
  EXPECT_EQ(bench.controller.stage(), Stage::kOff);
}

TEST(FirmwareController, CurrentsOfMissingMotorsAreABadCommand) {
  ArmConfig config = limited_arm();
  config.motors = 1;
  Bench bench(config);
  bench.start();
  EXPECT_FALSE(bench.off());
  bench.send(drive(1, 0.001f, 0));
  EXPECT_EQ(bench.controller.flags(), kBadCommand);
}

TEST(FirmwareController, RoundingBeyondTheLimitIsReducedToIt) {
  Bench bench;
  bench.start(2.01f, -2.01f, 0);
  EXPECT_EQ(bench.controller.outputs().amperes[0], 2);
  EXPECT_EQ(bench.controller.outputs().amperes[1], -2);
}

TEST(FirmwareController, SpeedBelowTheLimitIsNoFault) {
  // 400 rad/s at 2000 counts per turn are 127.3 counts per ms.
  for (const int step : {127, 128}) {
    Bench bench;
    for (int i = 0; i < 10; ++i) bench.tick();
    bench.start();
    for (int i = 0; i < 100; ++i) {
      bench.inputs.counts[2] -= step;
      bench.drive_until_fault(1);
    }
    EXPECT_EQ(bench.off(), step == 128) << step;
  }
}

TEST(FirmwareController, SpeedIsMeasuredOverTheWrapOfCounts) {
  Bench bench;
  bench.inputs.counts[0] = std::numeric_limits<std::int32_t>::max();
  for (int i = 0; i < 10; ++i) bench.tick();
  bench.start();
  bench.inputs.counts[0] = std::numeric_limits<std::int32_t>::min() + 20;
  bench.drive_until_fault(20);
  EXPECT_FALSE(bench.off());
}

TEST(FirmwareController, CountersAreSetWhileOffOnly) {
  Bench bench;
  bench.inputs.counts[0] = 500;
  bench.tick();
  bench.send(message(kSetCounters, std::array<std::int32_t, 3>{-7, 8, 9}));
  bench.inputs.counts[0] = 510;
  bench.tick();
  EXPECT_EQ(get<std::int32_t>(bench.state().data() + 8), 3);
  bench.start();
  bench.send(message(kSetCounters, std::array<std::int32_t, 3>{0, 0, 0}));
  bench.tick();
  EXPECT_EQ(get<std::int32_t>(bench.state().data() + 8), 3);
  EXPECT_EQ(get<std::uint16_t>(bench.state().data() + 42), 1);
}

TEST(FirmwareController, ReportsAreNumberedAndEchoTheHost) {
  Bench bench;
  bench.send(drive(0, 0, 0, 0xabcd));
  EXPECT_EQ(get<std::uint16_t>(bench.state().data() + 2), 0);
  const auto second = bench.state();
  EXPECT_EQ(get<std::uint16_t>(second.data() + 2), 1);
  EXPECT_EQ(get<std::uint16_t>(second.data() + 34), 0xabcd);
}

TEST(FirmwareController, LampBlinksForTheRequestedTime) {
  Bench bench;
  bench.send(message(kBlink, std::array<std::uint16_t, 1>{1000}));
  const std::uint32_t from_us = bench.now_us;
  int changes = 0;
  bool lit = bench.controller.lamp(from_us);
  EXPECT_TRUE(lit);
  for (std::uint32_t us = 0; us < 2'000'000; us += 1000) {
    const bool now = bench.controller.lamp(from_us + us);
    changes += now != lit;
    lit = now;
    if (us < 1'000'000) continue;
    EXPECT_FALSE(lit);
  }
  EXPECT_EQ(changes, 15);
}

TEST(FirmwareController, DescriptionIsRequestedByItsMessageOnly) {
  Bench bench;
  EXPECT_TRUE(bench.send(message(kDescribe)));
  EXPECT_FALSE(bench.send(message(kClear)));
  EXPECT_FALSE(bench.send(drive(0, 0, 0)));
}

TEST(FirmwareController, RestartIsReportedAndNoFault) {
  Bench bench(limited_arm(), 0, true);
  bench.start();
  EXPECT_FALSE(bench.off());
  EXPECT_EQ(get<std::uint16_t>(bench.state().data() + 20), kRestarted);
}

TEST(FirmwareController, LongestLoopIsReportedOnce) {
  Bench bench;
  bench.controller.loop_took(30);
  bench.controller.loop_took(20);
  EXPECT_EQ(get<std::uint16_t>(bench.state().data() + 44), 30);
  EXPECT_EQ(get<std::uint16_t>(bench.state().data() + 44), 0);
}

}  // namespace
}  // namespace thimble::firmware::test
