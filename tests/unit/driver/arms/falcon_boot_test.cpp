#include "arms/falcon/falcon_boot.h"

#include <gtest/gtest.h>

#include <fstream>

#include "support/boards/scripted_falcon.h"
#include "support/noise.h"
#include "support/scratch.h"

namespace thimble::driver::falcon {
namespace {

class FalconBoot : public ::testing::Test {
 protected:
  FalconBoot() {
    support::Random random(71);
    line_.image = support::any_bytes(random, 17 * kBlockSize + 11);
  }

  support::ScriptedFalcon line_;
  const BootSettings quick_{.greetings_max = 10, .answer_timeout_ms = 1, .settle_ms = 0};
};

TEST_F(FalconBoot, LoadsTheFirmwareAndEndsInRunMode) {
  const auto report = upload_firmware(line_, line_.image, quick_);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->attempts, 1);
  EXPECT_EQ(report->size, line_.image.size());
  EXPECT_TRUE(line_.running);
  EXPECT_EQ(line_.latency_ms, 1);
}

TEST_F(FalconBoot, TakesAnEchoInPiecesOfAnySize) {
  for (const int split : {1, 7, 61, 62}) {
    line_.running = false;
    line_.split = split;
    EXPECT_TRUE(upload_firmware(line_, line_.image, quick_)) << split;
  }
}

TEST_F(FalconBoot, GreetsOnlyUntilTheLoaderAnswers) {
  line_.greetings_unheard = 6;
  EXPECT_TRUE(upload_firmware(line_, line_.image, quick_));
  line_.running = false;
  line_.greetings_unheard = 1000;
  const auto failed = upload_firmware(line_, line_.image, quick_);
  ASSERT_FALSE(failed);
  EXPECT_NE(failed.error().message.find("power supply"), std::string::npos);
}

TEST_F(FalconBoot, RestartsAfterAWrongOrMissingEcho) {
  line_.echoes_wrong = 1;
  line_.echoes_missing = 1;
  const auto report = upload_firmware(line_, line_.image, quick_);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->attempts, 3);
  EXPECT_EQ(report->resumed_at, 2 * kBlockSize);
  EXPECT_EQ(line_.resets, 3);  // never continues with a loader that may have received a wrong byte
}

TEST_F(FalconBoot, GivesUpWithAReasonWhenEchoesStayWrong) {
  line_.echoes_wrong = 1000;
  const auto failed = upload_firmware(line_, line_.image, quick_);
  ASSERT_FALSE(failed);
  EXPECT_NE(failed.error().message.find("5 attempts"), std::string::npos);
  EXPECT_NE(failed.error().message.find("byte 62"), std::string::npos);
}

TEST_F(FalconBoot, RefusesAnImageThatDoesNotRun) {
  std::vector<std::byte> wrong = line_.image;
  wrong[100] ^= std::byte{1};
  const auto failed = upload_firmware(line_, wrong, quick_);
  ASSERT_FALSE(failed);
  EXPECT_NE(failed.error().message.find("did not answer after the upload"), std::string::npos);
}

TEST_F(FalconBoot, LeavesRunningFirmwareAlone) {
  line_.running = true;
  const auto report = prepare(line_, "", quick_);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_EQ(report->attempts, 0);
  EXPECT_EQ(line_.resets, 0);
  EXPECT_EQ(line_.last.motors, (std::array<std::int16_t, 3>{}));
}

TEST_F(FalconBoot, AsksForTheFirmwareFileAndReadsIt) {
  const auto asked = prepare(line_, "", quick_);
  ASSERT_FALSE(asked);
  EXPECT_NE(asked.error().message.find("--firmware"), std::string::npos);
  EXPECT_FALSE(prepare(line_, "/nowhere/falcon.bin", quick_));

  const auto file = support::scratch_folder() / "image.bin";
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(line_.image.data()),
             static_cast<std::streamsize>(line_.image.size()));
  const auto report = prepare(line_, file, quick_);
  ASSERT_TRUE(report) << report.error().message;
  EXPECT_TRUE(line_.running);
  std::ofstream(file, std::ios::trunc);
  EXPECT_FALSE(read_firmware(file));
}

TEST_F(FalconBoot, ReportsAMissingConverter) {
  line_.gone = true;
  EXPECT_FALSE(upload_firmware(line_, line_.image, quick_));
  EXPECT_FALSE(enter_run_mode(line_));
  EXPECT_FALSE(home_once(line_, 0, quick_).answered);
}

TEST_F(FalconBoot, HomesLegByLegWithZeroForceAndALight) {
  line_.running = true;
  ASSERT_TRUE(enter_run_mode(line_));
  std::uint8_t homed = 0;
  for (const int leg : {1, 2, 4}) {
    const HomingState state = home_once(line_, homed, quick_);
    ASSERT_TRUE(state.answered);
    EXPECT_FALSE(state.done());
    EXPECT_EQ(line_.last.lights, kHomingMode | kRedLight);
    line_.homed = static_cast<std::uint8_t>(line_.homed | leg);
    homed = home_once(line_, homed, quick_).homed;
  }
  EXPECT_EQ(homed, kAllHomed);
  const HomingState state = home_once(line_, homed, quick_);
  EXPECT_TRUE(state.done());
  EXPECT_EQ(state.counts, (std::array<std::int16_t, 3>{5, -6, 7}));
  EXPECT_EQ(line_.last.lights, kHomingMode | kGreenLight);
  EXPECT_EQ(line_.last.motors, (std::array<std::int16_t, 3>{}));
}

TEST_F(FalconBoot, FindsTheBeginningOfAnAnswerBehindStrayBytes) {
  line_.running = true;
  ASSERT_TRUE(enter_run_mode(line_));
  line_.homed = 5;
  for (const int stray : {1, 15, 60}) {
    line_.stray = stray;
    const HomingState state = home_once(line_, 0, quick_);
    EXPECT_TRUE(state.answered) << stray;
    EXPECT_EQ(state.homed, 5);
    EXPECT_EQ(state.counts, (std::array<std::int16_t, 3>{5, -6, 7}));
  }
  line_.stray = 5 * static_cast<int>(kPacketSize);
  EXPECT_FALSE(home_once(line_, 0, quick_).answered);
}

TEST_F(FalconBoot, AcceptsImagesOfUpTo64KB) {
  const auto file = support::scratch_folder() / "image_64k.bin";
  std::ofstream(file, std::ios::binary) << std::string(65'536, 'x');
  const auto largest = read_firmware(file);
  ASSERT_TRUE(largest) << largest.error().message;
  EXPECT_EQ(largest->size(), 65'536u);
  std::ofstream(file, std::ios::binary) << std::string(65'537, 'x');
  const auto beyond = read_firmware(file);
  ASSERT_FALSE(beyond);
  EXPECT_NE(beyond.error().message.find("larger than 64 kB"), std::string::npos);
}

}  // namespace
}  // namespace thimble::driver::falcon
