// The firmware of driver/firmware, compiled for a Cortex-M3 and emulated by QEMU. The image is
// built with this test; without the tools, the test is skipped.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>

#include "emulated_program.h"
#include "host_wire.h"
#include "program_flags.h"
#include "touch_rig.h"

namespace thimble::firmware_test {
namespace {

class EmulatedFirmware : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(THIMBLE_FIRMWARE_IMAGE)) {
      GTEST_SKIP() << "The firmware was not compiled. Install the part `firmware` "
                      "(app/optional_parts.list).";
    }
    program_ = EmulatedProgram::start(THIMBLE_FIRMWARE_IMAGE, box_config());
    ASSERT_TRUE(program_) << "QEMU did not start the firmware.";
  }

  std::unique_ptr<EmulatedProgram> program_;
};

TEST_F(EmulatedFirmware, TouchesASceneBitIdenticallyToTheHostBuild) {
  TouchRig emulated(program_.get()), host;
  ASSERT_TRUE(emulated.built() && host.built());
  while (emulated.now_ns() < 5'000'000'000) {
    emulated.tick();
    host.tick();
  }
  EXPECT_FALSE(program_->failed());
  EXPECT_GT(emulated.force_max(), 1);
  EXPECT_EQ(emulated.trace(), host.trace());
  RecordProperty("longest_pass_us", static_cast<int>(1e6 * program_->pass_max()));
  std::printf("Longest pass of 5000 ticks: %.1f us, %.0f instructions of a Cortex-M3\n",
              1e6 * program_->pass_max(), program_->pass_max() / 32e-9);
}

TEST_F(EmulatedFirmware, WatchdogActs50msAfterTheLineIsPulled) {
  TouchRig rig(program_.get());
  ASSERT_TRUE(rig.built());
  while (rig.now_ns() < 1'500'000'000) rig.tick();
  ASSERT_GT(rig.arm().firmware().currents().norm(), 0.01);
  rig.unplug();
  const std::int64_t due_ns = rig.now_ns() + rig.file().simulated.wire.delay_out_ns + 50'000'000;
  rig.pass(due_ns - 1000 - rig.now_ns());
  EXPECT_TRUE(program_->outputs().motors_on);
  rig.pass(1000);
  EXPECT_FALSE(program_->outputs().motors_on);
  EXPECT_EQ(rig.arm().firmware().currents().norm(), 0);
  EXPECT_FALSE(program_->failed());
}

TEST_F(EmulatedFirmware, EachCauseHasItsFlag) {
  check_every_flag(*program_);
  EXPECT_FALSE(program_->failed());
}

TEST_F(EmulatedFirmware, HardwareWatchdogRestartsItWithMotorsOff) {
  ProgramBench bench(*program_);
  bench.start();
  ASSERT_TRUE(bench.on());
  const auto description = program_->hang();
  ASSERT_EQ(description.size(), firmware::kDescriptionSize);
  EXPECT_EQ(firmware::get<std::uint16_t>(description.data() + 30), firmware::kRestarted);
  bench.tick();
  EXPECT_FALSE(bench.on());
  EXPECT_EQ(bench.flags(), firmware::kRestarted);
}

}  // namespace
}  // namespace thimble::firmware_test
