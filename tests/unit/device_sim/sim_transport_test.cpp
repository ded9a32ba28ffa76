#include "board/sim_transport.h"

#include <gtest/gtest.h>

#include <array>

#include "arms/hfab/hfab_report.h"
#include "vintage_simulation.h"

namespace thimble::device_sim {
namespace {

using driver::TransportStatus;

constexpr std::int64_t kOneMillisecond = 1'000'000;

class SimTransportTest : public ::testing::Test {
 protected:
  driver::VirtualClock clock_;
  SimulatedArm arm_ =
      SimulatedArm::make(support::vintage_model(), phantom_like(), resting_at(home_tip())).value();
  SimTransport transport_{clock_, arm_};
  std::array<std::byte, driver::kReportCapacity> buffer_{};
};

TEST_F(SimTransportTest, ReadsAvailableReportsWithoutWaiting) {
  const auto read = transport_.read_latest(buffer_, 10 * kOneMillisecond);
  EXPECT_EQ(read.status, TransportStatus::kOk);
  EXPECT_EQ(read.size, driver::hfab::kReportSize);
  EXPECT_EQ(clock_.now_ns(), 0);
}

TEST_F(SimTransportTest, WaitsOnlyUntilTheNextReport) {
  transport_.read_latest(buffer_, 0);
  const auto read = transport_.read_latest(buffer_, 10 * kOneMillisecond);
  EXPECT_EQ(read.status, TransportStatus::kOk);
  EXPECT_EQ(read.skipped, 0U);
  EXPECT_EQ(clock_.now_ns(), kOneMillisecond);
}

TEST_F(SimTransportTest, NeverWaitsBeyondItsDeadline) {
  transport_.read_latest(buffer_, 0);
  const auto read = transport_.read_latest(buffer_, 400'000);
  EXPECT_EQ(read.status, TransportStatus::kNothing);
  EXPECT_EQ(read.size, 0U);
  EXPECT_EQ(clock_.now_ns(), 400'000);
  EXPECT_EQ(transport_.read_latest(buffer_, 0).status, TransportStatus::kNothing);
  EXPECT_EQ(clock_.now_ns(), 400'000);
}

TEST_F(SimTransportTest, SkipsToTheNewestReport) {
  clock_.sleep_until_ns(30 * kOneMillisecond);
  const auto read = transport_.read_latest(buffer_, 0);
  EXPECT_EQ(read.status, TransportStatus::kOk);
  EXPECT_EQ(read.skipped, 30U);
}

TEST_F(SimTransportTest, WritesAtTheClocksTime) {
  clock_.sleep_until_ns(7'777);
  EXPECT_EQ(transport_.write(drive_message(100, 0, 0)), TransportStatus::kOk);
  EXPECT_EQ(arm_.time_ns(), 7'777);
  EXPECT_EQ(arm_.firmware().watchdog_due_ns(), 100'007'777);
}

TEST_F(SimTransportTest, FirmwareContinuesWhenUnplugged) {
  transport_.write(drive_message(100, 0, 0));
  transport_.unplug();
  EXPECT_EQ(transport_.read_latest(buffer_, 5 * kOneMillisecond).status, TransportStatus::kLost);
  EXPECT_EQ(clock_.now_ns(), 0);
  clock_.sleep_until_ns(50 * kOneMillisecond);
  EXPECT_EQ(transport_.write(drive_message(200, 0, 0)), TransportStatus::kLost);
  EXPECT_EQ(arm_.plant().currents().x(), 0.1);
  clock_.sleep_until_ns(100 * kOneMillisecond);
  EXPECT_EQ(transport_.read_latest(buffer_, 0).status, TransportStatus::kLost);
  EXPECT_EQ(arm_.plant().currents().x(), 0);
  EXPECT_EQ(arm_.firmware().counters().watchdog_fired, 1U);
}

}  // namespace
}  // namespace thimble::device_sim
