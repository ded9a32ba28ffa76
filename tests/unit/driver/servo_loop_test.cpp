#include "thimble/driver/servo_loop.h"
#include "thimble/driver/wire_link.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "arms/hfab/hfab_report.h"
#include "support/boards/scripted_transport.h"
#include "support/vintage_arm.h"

namespace thimble::driver {
namespace {

/// Stores all records without allocating during the loop.
struct Records {
  std::vector<TickRecord> rows;
  explicit Records(std::size_t capacity) { rows.reserve(capacity); }
  void operator()(const TickRecord& record) noexcept {
    if (rows.size() < rows.capacity()) rows.push_back(record);
  }
};

/// A virtual clock that wakes too late once.
class LateClock final : public Clock {
 public:
  std::int64_t late_at_ns = -1, late_by_ns = 0;
  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void sleep_until_ns(std::int64_t time_ns) noexcept override {
    if (time_ns > now_ns_) now_ns_ = time_ns;
    if (late_at_ns >= 0 && now_ns_ >= late_at_ns) {
      now_ns_ += late_by_ns;
      late_at_ns = -1;
    }
  }

 private:
  std::int64_t now_ns_ = 0;
};

/// A transport that always has a report: of the arm in its home pose, or moved by some counts since
/// the last report.
class HomeTransport final : public Transport {
 public:
  HomeTransport(support::Wire& wire, const std::int16_t& counts) : wire_(wire), counts_(counts) {}
  TransportRead read_latest(std::span<std::byte> buffer, std::int64_t) noexcept override {
    if (wire_.lost) return {.status = TransportStatus::kLost};
    hfab::InputReport report;
    for (auto& count : report.counts) count = at_;
    at_ = static_cast<std::int16_t>(at_ + counts_);
    const auto bytes = hfab::encode_input(report);
    std::copy(bytes.begin(), bytes.end(), buffer.begin());
    return {.status = TransportStatus::kOk, .size = bytes.size()};
  }
  TransportStatus write(std::span<const std::byte> report) noexcept override {
    if (wire_.lost) return TransportStatus::kLost;
    wire_.to_arm.emplace_back(report.begin(), report.end());
    return TransportStatus::kOk;
  }

 private:
  support::Wire& wire_;
  const std::int16_t& counts_;  // from one report to the next
  std::int16_t at_ = 0;
};

class ServoLoopTest : public ::testing::Test {
 protected:
  void SetUp() override {
    auto opened = Device::open(
        std::make_unique<WireLink>(std::make_unique<HomeTransport>(wire_, counts_),
                                   std::make_unique<hfab::HfabArm>(support::vintage_model())),
        support::vintage_settings(), 0);
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
    ASSERT_TRUE(device_->activate());
  }

  bool ends_in_zero() const {
    return hfab::decode_output(wire_.to_arm.back())->current_mA == std::array<std::int16_t, 3>{};
  }

  support::Wire wire_;
  std::int16_t counts_ = 0;
  std::unique_ptr<Device> device_;
  std::atomic<bool> stop_{false};
};

TEST(ForceCommand, ScalesForcesAndStoredEnergyAlike) {
  ForceCommand command;
  command.f_T_W = {4, -2, 1};
  command.f_program_W = {2, 0, -6};
  command.stored = 3;
  scale(command, 0.25);
  EXPECT_EQ(command.f_T_W, Eigen::Vector3d(1, -0.5, 0.25));
  EXPECT_EQ(command.f_program_W, Eigen::Vector3d(0.5, 0, -1.5));
  EXPECT_EQ(command.stored, 0.75);
}

TEST_F(ServoLoopTest, RunsEvenlyAndEndsWithZeroForce) {
  VirtualClock clock;
  Records records(2000);
  auto law = [](const DeviceState&) noexcept {
    return ForceCommand{.f_T_W = {1, 0, 0}, .touch = {}};
  };
  EXPECT_EQ(run_servo(*device_, clock, ForceLaw(law), TickSink(records), {.ticks = 1000}, stop_),
            ServoEnd::kDone);
  ASSERT_EQ(records.rows.size(), 1000u);
  for (std::size_t i = 0; i < records.rows.size(); ++i) {
    EXPECT_EQ(records.rows[i].time_ns, static_cast<std::int64_t>(i) * 1'000'000);
    EXPECT_EQ(records.rows[i].tick, i);
  }
  EXPECT_EQ(records.rows.back().f_sent_W, (std::array<double, 3>{1, 0, 0}));
  EXPECT_TRUE(ends_in_zero());
  EXPECT_EQ(device_->stage(), DeviceStage::kIdle);
}

TEST_F(ServoLoopTest, StepAfterTheEndSendsNothing) {
  VirtualClock clock;
  Records records(100);
  auto law = [](const DeviceState&) noexcept {
    return ForceCommand{.f_T_W = {1, 0, 0}, .touch = {}};
  };
  ServoLoop loop(*device_, clock, ForceLaw(law), TickSink(records), {.ticks = 3});
  for (std::size_t tick = 1; tick <= 3; ++tick) {
    EXPECT_EQ(loop.tick(stop_), std::nullopt);
    ASSERT_EQ(records.rows.size(), tick);
    EXPECT_EQ(records.rows.back().time_ns, static_cast<std::int64_t>(tick - 1) * 1'000'000);
    EXPECT_EQ(device_->stage(), DeviceStage::kActive);
  }
  EXPECT_EQ(loop.tick(stop_), ServoEnd::kDone);
  EXPECT_TRUE(ends_in_zero());
  EXPECT_EQ(device_->stage(), DeviceStage::kIdle);
  const std::size_t sent = wire_.to_arm.size();
  stop_.store(true);
  EXPECT_EQ(loop.tick(stop_), ServoEnd::kDone);
  EXPECT_EQ(wire_.to_arm.size(), sent);
  EXPECT_EQ(records.rows.size(), 3u);
}

TEST_F(ServoLoopTest, CopiesOfLawAndSinkReferToTheOriginal) {
  auto law = [](const DeviceState&) noexcept {
    return ForceCommand{.f_T_W = {1, 2, 3}, .touch = {}};
  };
  Records records(10);
  std::optional<ForceLaw> copy;
  std::optional<TickSink> sink_copy;
  {
    ForceLaw first(law);  // not const: a copy of it must not refer to it
    ForceLaw second(first);
    copy = second;
    TickSink first_sink(records);
    sink_copy = first_sink;
    auto other = [](const DeviceState&) noexcept { return ForceCommand{}; };
    first = ForceLaw(other);
    second = ForceLaw(other);
  }
  EXPECT_EQ((*copy)(DeviceState{}).f_T_W, Eigen::Vector3d(1, 2, 3));
  (*sink_copy)(TickRecord{});
  EXPECT_EQ(records.rows.size(), 1u);
}

TEST_F(ServoLoopTest, SkipsMissedTicksInsteadOfRunningThemInABurst) {
  LateClock clock;
  clock.late_at_ns = 5'000'000;
  clock.late_by_ns = 2'300'000;
  Records records(100);
  auto law = [](const DeviceState&) noexcept { return ForceCommand{}; };
  run_servo(*device_, clock, ForceLaw(law), TickSink(records), {.ticks = 10}, stop_);
  std::vector<std::int64_t> times;
  for (const auto& row : records.rows) times.push_back(row.time_ns / 100'000);
  // The tick due at 5.0 ms ran at 7.3 ms; the ones due at 6 and 7 ms were skipped.
  EXPECT_EQ(times, (std::vector<std::int64_t>{0, 10, 20, 30, 40, 73, 80, 90}));
  EXPECT_EQ(records.rows[5].due_ns, 5'000'000);
}

/// A law that records the times and states of its calls to prepare.
struct PreparedLaw {
  const Clock& clock;
  struct Call {
    std::int64_t time_ns;
    std::uint64_t ticks_before;
    Eigen::Vector3d expected_p_WT, p_WT, v_WT;  // of the tick before
  };
  mutable std::vector<Call> calls;
  std::uint64_t ticks = 0;
  Eigen::Vector3d last_p_WT{0, 0, 0}, last_v_WT{0, 0, 0};

  explicit PreparedLaw(const Clock& of) : clock(of) { calls.reserve(100); }
  ForceCommand operator()(const DeviceState& state) noexcept {
    ++ticks;
    last_p_WT = state.p_WT;
    last_v_WT = state.v_WT;
    return {};
  }
  void prepare(const DeviceState& expected) const noexcept {
    calls.push_back({clock.now_ns(), ticks, expected.p_WT, last_p_WT, last_v_WT});
  }
};

TEST_F(ServoLoopTest, LawPreparesBeforeEachPunctualTick) {
  LateClock clock;
  clock.late_at_ns = 4'990'000;  // wakes 2.3 ms too late to prepare the tick at 5 ms
  clock.late_by_ns = 2'300'000;
  Records records(100);
  PreparedLaw law(clock);
  counts_ = 2;
  run_servo(*device_, clock, ForceLaw(law), TickSink(records), {.ticks = 10, .prepare_ns = 10'000},
            stop_);
  std::vector<std::int64_t> times;
  for (const auto& row : records.rows) times.push_back(row.time_ns / 100'000);
  EXPECT_EQ(times, (std::vector<std::int64_t>{0, 10, 20, 30, 40, 72, 80, 90}));
  std::vector<std::int64_t> calls;
  std::vector<std::uint64_t> before;
  for (const auto& call : law.calls) {
    calls.push_back(call.time_ns / 1000);
    before.push_back(call.ticks_before);
    const Eigen::Vector3d on_its_way = call.p_WT + 1e-3 * call.v_WT;
    EXPECT_EQ(call.expected_p_WT, on_its_way);
  }
  EXPECT_GT(law.calls.back().v_WT.norm(), 1e-3);
  // No call before the first tick, which is due at once, and none before the late tick.
  EXPECT_EQ(calls, (std::vector<std::int64_t>{990, 1990, 2990, 3990, 7990, 8990}));
  EXPECT_EQ(before, (std::vector<std::uint64_t>{1, 2, 3, 4, 6, 7}));
}

TEST_F(ServoLoopTest, DoesNotPrepareLawsByDefault) {
  VirtualClock clock;
  Records records(100);
  PreparedLaw law(clock);
  run_servo(*device_, clock, ForceLaw(law), TickSink(records), {.ticks = 10}, stop_);
  EXPECT_EQ(records.rows.size(), 10u);
  EXPECT_TRUE(law.calls.empty());
}

TEST_F(ServoLoopTest, StopsWithinOneTickOfTheStopFlagAndSendsZero) {
  VirtualClock clock;
  Records records(1000);
  auto law = [this](const DeviceState& state) noexcept {
    if (state.tick == 400) stop_.store(true);
    return ForceCommand{.f_T_W = {1, 0, 0}, .touch = {}};
  };
  EXPECT_EQ(run_servo(*device_, clock, ForceLaw(law), TickSink(records), {}, stop_),
            ServoEnd::kStopped);
  EXPECT_EQ(records.rows.size(), 401u);
  EXPECT_TRUE(ends_in_zero());
}

TEST_F(ServoLoopTest, FaultEndsTheLoopWithZeroForce) {
  VirtualClock clock;
  Records records(1000);
  auto law = [](const DeviceState& state) noexcept {
    return ForceCommand{.f_T_W = {state.tick == 350 ? NAN : 1.0, 0, 0}, .touch = {}};
  };
  EXPECT_EQ(run_servo(*device_, clock, ForceLaw(law), TickSink(records), {}, stop_),
            ServoEnd::kFault);
  ASSERT_EQ(records.rows.size(), 351u);
  EXPECT_EQ(records.rows.back().fault, Fault::kForceNotFinite);
  EXPECT_EQ(records.rows.back().stage, DeviceStage::kFault);
  EXPECT_EQ(records.rows.back().f_sent_W, (std::array<double, 3>{}));
  EXPECT_TRUE(ends_in_zero());
}

TEST_F(ServoLoopTest, EndsWhenTheArmIsPulledOff) {
  VirtualClock clock;
  Records records(1000);
  auto law = [this](const DeviceState& state) noexcept {
    if (state.tick == 350) wire_.lost = true;
    return ForceCommand{.f_T_W = {1, 0, 0}, .touch = {}};
  };
  EXPECT_EQ(run_servo(*device_, clock, ForceLaw(law), TickSink(records), {}, stop_),
            ServoEnd::kFault);
  EXPECT_EQ(device_->fault(), Fault::kTransportLost);
  EXPECT_EQ(records.rows.size(), 351u);
}

TEST_F(ServoLoopTest, ExceptionLeavesZeroForce) {
  VirtualClock clock;
  Records records(1000);
  auto law = [](const DeviceState&) noexcept {
    return ForceCommand{.f_T_W = {1, 0, 0}, .touch = {}};
  };
  try {
    const std::unique_ptr<Device> owned = std::move(device_);
    for (int k = 0; k < 400; ++k) {
      clock.sleep_until_ns(clock.now_ns() + 1'000'000);
      owned->read(clock.now_ns(), clock.now_ns());
      owned->write(law(owned->state()));
    }
    ASSERT_FALSE(ends_in_zero());
    throw std::runtime_error("the application's own trouble");
  } catch (const std::runtime_error&) {
  }
  EXPECT_TRUE(ends_in_zero());
}

TEST(WallClock, SleepsAtLeastUntilTheRequestedTime) {
  WallClock clock;
  const std::int64_t start_ns = clock.now_ns();
  clock.sleep_until_ns(start_ns + 3'000'000);
  EXPECT_GE(clock.now_ns(), start_ns + 3'000'000);
  clock.sleep_until_ns(start_ns);  // in the past: returns at once
  EXPECT_GE(clock.now_ns(), start_ns + 3'000'000);
}

}  // namespace
}  // namespace thimble::driver
