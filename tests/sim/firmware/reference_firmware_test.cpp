// Scenes and faults with the firmware of driver/firmware in the simulated arm, in this process.
#include <gtest/gtest.h>

#include "host_wire.h"
#include "program_flags.h"
#include "support/heap_guard.h"
#include "touch_rig.h"

namespace thimble::firmware_test {
namespace {

TEST(ReferenceFirmware, TouchesASceneThroughItsWire) {
  TouchRig rig;
  ASSERT_TRUE(rig.built());
  for (int i = 0; i < 5000; ++i) rig.tick();
  EXPECT_GT(rig.force_max(), 1);
  EXPECT_TRUE(rig.arm().firmware().motors_on());
  EXPECT_EQ(rig.device().fault(), driver::Fault());
}

TEST(ReferenceFirmware, WatchdogActs50msAfterTheLastMessage) {
  TouchRig rig;
  ASSERT_TRUE(rig.built());
  while (rig.now_ns() < 1'500'000'000) rig.tick();
  ASSERT_GT(rig.arm().firmware().currents().norm(), 0.01);
  rig.unplug();
  // The last message is on its way for the delay of the wire.
  const std::int64_t due_ns = rig.now_ns() + rig.file().simulated.wire.delay_out_ns + 50'000'000;
  rig.pass(due_ns - 1 - rig.now_ns());
  EXPECT_GT(rig.arm().firmware().currents().norm(), 0.01);
  rig.pass(1);
  EXPECT_EQ(rig.arm().firmware().currents().norm(), 0);
  EXPECT_FALSE(rig.arm().firmware().motors_on());
  EXPECT_EQ(rig.arm().firmware().counters().watchdog_fired, 1u);
}

TEST(ReferenceFirmware, EachCauseHasItsFlag) {
  device_sim::HostProgram program(box_config());
  check_every_flag(program);
}

TEST(ReferenceFirmware, BrownOutDuringATouchEndsTheForce) {
  TouchRig rig;
  ASSERT_TRUE(rig.built());
  while (rig.now_ns() < 1'500'000'000) rig.tick();
  ASSERT_GT(rig.arm().firmware().currents().norm(), 0.01);
  rig.arm().set_board_health({.supply_mV = 11'000});
  rig.tick();
  rig.tick();
  EXPECT_EQ(rig.arm().firmware().currents().norm(), 0);
  rig.arm().set_board_health({});
  for (int i = 0; i < 100; ++i) rig.tick();
  EXPECT_EQ(rig.arm().firmware().currents().norm(), 0) << "not latched";
}

TEST(ReferenceFirmware, RestartedBoardNeedsAZeroMessage) {
  TouchRig rig;
  ASSERT_TRUE(rig.built());
  while (rig.now_ns() < 1'500'000'000) rig.tick();
  rig.arm().restart_board();
  const auto nonzero = drive(0.5f);
  rig.arm().put_message(std::as_bytes(std::span(nonzero)));
  rig.pass(5'000'000);
  EXPECT_FALSE(rig.arm().firmware().motors_on());
  const auto zero = drive(0);
  rig.arm().put_message(std::as_bytes(std::span(zero)));
  rig.pass(5'000'000);
  EXPECT_TRUE(rig.arm().firmware().motors_on());
}

TEST(ReferenceFirmware, DescribesTheMotorsOfTheArm) {
  struct Case {
    const char* arm;
    int motors;
    firmware::Geometry geometry;
  };
  for (const Case& one : {Case{"vintage_phantom", 3, firmware::Geometry::kSerial},
                          Case{"polhem", 3, firmware::Geometry::kLinkage},
                          Case{"falcon", 3, firmware::Geometry::kDelta},
                          Case{"five_bar", 2, firmware::Geometry::kFiveBar},
                          Case{"hapkit", 1, firmware::Geometry::kPaddle}}) {
    SCOPED_TRACE(one.arm);
    const scene::ArmFile file = scene::load_arm(one.arm).value();
    const firmware::ArmConfig config =
        device_sim::reference_config(file.model, reference_settings(file, nullptr).firmware);
    EXPECT_EQ(config.motors, one.motors);
    EXPECT_EQ(config.geometry, one.geometry);
    for (int i = 0; i < 3; ++i) EXPECT_EQ(config.counts_per_turn[i] > 0, i < one.motors);
  }
}

TEST(ReferenceFirmware, CurrentOfAMotorThatTheArmLacksIsRefused) {
  const scene::ArmFile file = scene::load_arm("five_bar").value();
  device_sim::HostProgram program(
      device_sim::reference_config(file.model, reference_settings(file, nullptr).firmware));
  const auto message = [](float second, float third) {
    std::vector<std::uint8_t> bytes = drive(0);
    bytes.resize(16);  // without its CRC
    firmware::put(bytes.data() + 8, second);
    firmware::put(bytes.data() + 12, third);
    return closed(bytes);
  };
  ProgramBench bench(program);
  bench.tick();
  bench.send(drive(0));
  bench.send(message(0.1f, 0));
  bench.tick();
  EXPECT_TRUE(bench.on());
  EXPECT_EQ(bench.flags(), 0);
  bench.send(message(0.1f, 0.1f));
  bench.tick();
  EXPECT_FALSE(bench.on());
  EXPECT_EQ(bench.flags(), firmware::kBadCommand);
}

TEST(ReferenceFirmware, AllocatesNothingInATick) {
  TouchRig rig;
  ASSERT_TRUE(rig.built());
  for (int i = 0; i < 1000; ++i) rig.tick();
  EXPECT_EQ(support::heap_calls_of([&] { rig.pass(1'000'000'000); }), 0);
}

}  // namespace
}  // namespace thimble::firmware_test
