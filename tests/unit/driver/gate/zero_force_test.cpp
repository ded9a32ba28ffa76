// The end of a run on a wire that refuses messages: zero force is sent again, and the acting force
// is reported.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "arms/hfab/hfab_report.h"
#include "support/boards/scripted_transport.h"
#include "support/vintage_arm.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/wire_link.h"

namespace thimble::driver::zero_force_test {
namespace {

using Eigen::Vector3d;

constexpr std::int64_t kPeriod_ns = 1'000'000;
constexpr int kForGood = std::numeric_limits<int>::max();
const Vector3d kPush{0, 0.5, 0};

std::vector<std::byte> report(std::int16_t yaw = 0) {
  hfab::InputReport input;
  input.counts = {yaw, 0, 0, 0, 0, 0};
  const auto bytes = hfab::encode_input(input);
  return {bytes.begin(), bytes.end()};
}

/// A device that pushes with 0.5 N in the home pose, on a wire that can refuse messages.
class ZeroForce : public ::testing::Test {
 protected:
  void open(const DeviceSettings& settings = support::vintage_settings()) {
    wire_.to_host.push_back(report());
    auto opened = Device::open(
        std::make_unique<WireLink>(std::make_unique<support::ScriptedTransport>(wire_),
                                   std::make_unique<hfab::HfabArm>(support::vintage_model())),
        settings, now_ns_);
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
    EXPECT_TRUE(device_->zero_assured());
    ASSERT_TRUE(device_->activate());
    for (int k = 0; k < 400; ++k) tick(kPush);
    ASSERT_EQ(device_->f_sent_W(), kPush);
    ASSERT_FALSE(device_->zero_assured());
  }

  void tick(const Vector3d& f_T_W, std::int16_t yaw = 0) {
    wire_.to_host.push_back(report(yaw));
    now_ns_ += kPeriod_ns;
    device_->read(now_ns_, now_ns_);
    device_->write({.f_T_W = f_T_W, .touch = {}});
  }

  bool arm_got_zero() const {
    return hfab::decode_output(wire_.to_arm.back())->current_mA == std::array<std::int16_t, 3>{};
  }

  support::Wire wire_;
  std::int64_t now_ns_ = 0;
  std::unique_ptr<Device> device_;
};

TEST_F(ZeroForce, IsResentAtOnceWhenRefused) {
  open();
  wire_.refusals = 1;
  device_->deactivate();
  EXPECT_TRUE(arm_got_zero());
  EXPECT_TRUE(device_->zero_assured());
  EXPECT_EQ(device_->f_sent_W(), Vector3d(0, 0, 0));
}

TEST_F(ZeroForce, IsReportedOnlyWhenAcknowledged) {
  open();
  wire_.refusals = 3;
  device_->deactivate();
  EXPECT_FALSE(arm_got_zero());
  EXPECT_FALSE(device_->zero_assured());
  EXPECT_EQ(device_->f_sent_W(), kPush);  // it still acts
  EXPECT_EQ(device_->stage(), DeviceStage::kIdle);
  tick(kPush);
  EXPECT_EQ(device_->f_sent_W(), kPush);
  tick(kPush);
  EXPECT_TRUE(arm_got_zero());
  EXPECT_TRUE(device_->zero_assured());
  EXPECT_EQ(device_->f_sent_W(), Vector3d(0, 0, 0));
}

/// Runs a loop of three ticks to its end.
ServoEnd run_to_end(Device& device, Clock& clock, support::Wire& wire, int refusals) {
  auto law = [](const DeviceState&) noexcept { return ForceCommand{.f_T_W = kPush, .touch = {}}; };
  int ticks = 0;
  auto sink = [&](const TickRecord&) noexcept {
    if (++ticks == 3) wire.refusals = refusals;
  };
  ServoLoop loop(device, clock, ForceLaw(law), TickSink(sink), {.ticks = 3});
  const std::atomic<bool> stop{false};
  for (;;) {
    if (const auto end = loop.tick(stop)) return *end;
  }
}

TEST_F(ZeroForce, IsRepeatedAtTheEndOfALoopUntilTaken) {
  open();
  VirtualClock clock;
  clock.sleep_until_ns(now_ns_ + kPeriod_ns);
  const std::int64_t begin_ns = clock.now_ns();
  // Two at once, then one in each of 30 ms.
  EXPECT_EQ(run_to_end(*device_, clock, wire_, 31), ServoEnd::kDone);
  EXPECT_TRUE(arm_got_zero());
  EXPECT_TRUE(device_->zero_assured());
  EXPECT_EQ(device_->fault(), Fault::kNone);
  EXPECT_EQ(clock.now_ns() - begin_ns, (2 + 30) * kPeriod_ns);
}

TEST_F(ZeroForce, IsRetriedUntilTheWatchdogTime) {
  open();
  VirtualClock clock;
  clock.sleep_until_ns(now_ns_ + kPeriod_ns);
  const std::int64_t begin_ns = clock.now_ns();
  EXPECT_EQ(run_to_end(*device_, clock, wire_, kForGood), ServoEnd::kDone);
  EXPECT_FALSE(arm_got_zero());
  EXPECT_FALSE(device_->zero_assured());
  EXPECT_EQ(device_->fault(), Fault::kRefused);
  EXPECT_EQ(device_->f_sent_W(), kPush);
  const double waited = static_cast<double>(clock.now_ns() - begin_ns) * 1e-9 - 0.002;
  EXPECT_GE(waited, 0.1);  // watchdog_ns
  EXPECT_LE(waited, 0.102);
}

/// A clock that does not advance.
class DeadClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override { return 0; }
  void sleep_until_ns(std::int64_t) noexcept override { ++sleeps; }
  int sleeps = 0;
};

TEST_F(ZeroForce, RepetitionEndsWithAStoppedClock) {
  open();
  wire_.refusals = kForGood;
  device_->deactivate();
  DeadClock clock;
  EXPECT_FALSE(device_->insist_on_zero(clock));
  EXPECT_EQ(clock.sleeps, 101);
  EXPECT_EQ(device_->fault(), Fault::kRefused);
}

/// A clock for a wire on which each message takes 60 ms to be refused.
class SlowClock final : public Clock {
 public:
  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void sleep_until_ns(std::int64_t) noexcept override {
    now_ns_ += 60'000'000;
    ++sleeps;
  }
  int sleeps = 0;

 private:
  std::int64_t now_ns_ = 0;
};

TEST_F(ZeroForce, RepetitionEndsIfEachMessageWaits) {
  open();
  wire_.refusals = kForGood;
  device_->deactivate();
  SlowClock clock;
  EXPECT_FALSE(device_->insist_on_zero(clock));
  EXPECT_EQ(clock.sleeps, 2);  // after them 120 ms have passed
}

TEST_F(ZeroForce, IsRepeatedByTheDestructor) {
  open();
  wire_.refusals = 3;  // two at once and one in the next millisecond of real time
  device_.reset();
  EXPECT_TRUE(arm_got_zero());
}

TEST_F(ZeroForce, IsNotAssuredByALostWire) {
  open();
  wire_.lost = true;
  device_->deactivate();
  EXPECT_FALSE(device_->zero_assured());
  EXPECT_EQ(device_->fault(), Fault::kTransportLost);
  EXPECT_EQ(device_->f_sent_W(), Vector3d(0, 0, 0));  // nothing is sent any more
}

TEST_F(ZeroForce, IsNotAssuredAfterARefusedForce) {
  // The message may have arrived nevertheless.
  wire_.to_host.push_back(report());
  auto opened = Device::open(
      std::make_unique<WireLink>(std::make_unique<support::ScriptedTransport>(wire_),
                                 std::make_unique<hfab::HfabArm>(support::vintage_model())),
      support::vintage_settings(), now_ns_);
  ASSERT_TRUE(opened);
  device_ = std::move(opened).value();
  ASSERT_TRUE(device_->activate());
  tick({0, 0, 0});
  EXPECT_TRUE(device_->zero_assured());
  wire_.refusals = kForGood;
  tick(kPush);
  tick(kPush);
  EXPECT_EQ(device_->f_sent_W(), Vector3d(0, 0, 0));
  EXPECT_FALSE(device_->zero_assured());
  device_->deactivate();
  EXPECT_FALSE(device_->zero_assured());
  wire_.refusals = 0;
  device_->deactivate();
  EXPECT_TRUE(arm_got_zero());
  EXPECT_TRUE(device_->zero_assured());
}

/// A clock with which the last message is sent after `leaves_after` sleeps.
class LeavingClock final : public Clock {
 public:
  LeavingClock(support::Wire& wire, int leaves_after, TransportStatus outcome)
      : wire_(wire), left_(leaves_after), outcome_(outcome) {}
  std::int64_t now_ns() const noexcept override { return now_ns_; }
  void sleep_until_ns(std::int64_t time_ns) noexcept override {
    now_ns_ = time_ns;
    if (--left_ == 0) wire_.settled = outcome_;
  }

 private:
  support::Wire& wire_;
  int left_;
  TransportStatus outcome_;
  std::int64_t now_ns_ = 0;
};

TEST_F(ZeroForce, IsNotAssuredInTransit) {
  open();
  wire_.settled = TransportStatus::kNothing;
  device_->deactivate();
  EXPECT_FALSE(device_->zero_assured());
  const std::size_t sent = wire_.to_arm.size();
  LeavingClock clock(wire_, 5, TransportStatus::kOk);
  EXPECT_TRUE(device_->insist_on_zero(clock));
  EXPECT_EQ(clock.now_ns(), 5 * kPeriod_ns);
  EXPECT_EQ(wire_.to_arm.size(), sent) << "the device waits for it and does not send it again";
  EXPECT_EQ(device_->fault(), Fault::kNone);
}

TEST_F(ZeroForce, IsResentWhenItFailedInTransit) {
  open();
  wire_.settled = TransportStatus::kNothing;
  device_->deactivate();
  const std::size_t sent = wire_.to_arm.size();
  LeavingClock clock(wire_, 3, TransportStatus::kRefused);
  EXPECT_FALSE(device_->insist_on_zero(clock));
  EXPECT_GT(wire_.to_arm.size(), sent);
  EXPECT_EQ(device_->fault(), Fault::kRefused);
  wire_.settled = TransportStatus::kOk;
  EXPECT_TRUE(device_->zero_assured());
}

TEST_F(ZeroForce, IsNotAssuredIfTheWireIsLostInTransit) {
  open();
  wire_.settled = TransportStatus::kNothing;
  device_->deactivate();
  wire_.lost = true;
  device_->read(now_ns_ += kPeriod_ns, 0);
  EXPECT_TRUE(device_->lost());
  EXPECT_FALSE(device_->zero_assured());
}

TEST_F(ZeroForce, RefusedTickKeepsThePreviousForce) {
  open();
  wire_.refusals = 10;
  for (int k = 0; k < 10; ++k) {
    tick({0, 4, 0});
    EXPECT_EQ(device_->f_sent_W(), kPush);
  }
  // The arm still holds 0.5 N, and at most 2 N per tick may be added.
  tick({0, 4, 0});
  EXPECT_NEAR(device_->f_sent_W().y(), 2.5, 1e-12);
  EXPECT_EQ(device_->fault(), Fault::kNone);
}

TEST_F(ZeroForce, RefusedZeroKeepsThePreviousForceInTheAccount) {
  DeviceSettings settings = support::vintage_settings();
  settings.energy = {
      .stage = EnergyStage::kPassivity, .mass = 0.075, .allowance = 1, .reservoir = 0.02};
  open(settings);
  const double before = device_->gate().energy();
  const double y_before = device_->state().p_WT.y();
  wire_.refusals = 12;
  // The law requests zero at once, the arm keeps its force, and the hand is pushed.
  for (int k = 1; k <= 11; ++k) tick({0, 0, 0}, static_cast<std::int16_t>(-k));
  const double way = device_->state().p_WT.y() - y_before;
  EXPECT_GT(way, 2e-4);
  EXPECT_NEAR(before - device_->gate().energy(), 0.5 * way, 0.01 * 0.5 * way);
}

TEST_F(ZeroForce, FollowsABackwardClock) {
  for (const EnergyStage stage : {EnergyStage::kNone, EnergyStage::kPassivity}) {
    DeviceSettings settings = support::vintage_settings();
    settings.energy = {.stage = stage, .mass = 0.075, .allowance = 1, .reservoir = 0.02};
    open(settings);
    now_ns_ -= 10'000'000;
    for (int k = 0; k < 30; ++k) {
      tick(kPush);
      EXPECT_EQ(device_->fault(), Fault::kTimeNotMonotonic);
      EXPECT_TRUE(arm_got_zero());
      EXPECT_EQ(device_->f_sent_W(), Vector3d(0, 0, 0));
    }
    ASSERT_TRUE(device_->activate());
    for (int k = 0; k < 400; ++k) tick(kPush);
    EXPECT_EQ(device_->f_sent_W(), kPush);
    device_.reset();
  }
}

TEST_F(ZeroForce, FollowsABackwardClockWithoutAWrite) {
  open();
  now_ns_ -= 10'000'000;
  device_->read(now_ns_, now_ns_);
  EXPECT_EQ(device_->fault(), Fault::kTimeNotMonotonic);
  EXPECT_EQ(device_->stage(), DeviceStage::kFault);
}

TEST(LooseLimits, AreRefusedByName) {
  const auto refusal = [](const DeviceSettings& settings) {
    support::Wire wire;
    wire.to_host.push_back(report());
    const auto opened = Device::open(
        std::make_unique<WireLink>(std::make_unique<support::ScriptedTransport>(wire),
                                   std::make_unique<hfab::HfabArm>(support::vintage_model())),
        settings, 0);
    return opened ? std::string() : opened.error().message;
  };
  const auto with = [&](auto change) {
    DeviceSettings settings = support::vintage_settings();
    change(settings.limits);
    return refusal(settings);
  };
  EXPECT_EQ(with([](GateLimits&) {}), "");
  EXPECT_EQ(with([](GateLimits& limits) { limits.soft_start = 0.05; }), "");
  EXPECT_EQ(with([](GateLimits& limits) { limits.rise_max = 1e5; }), "");
  EXPECT_EQ(with([](GateLimits& limits) { limits.watchdog_ns = 1'000'000'000; }), "");
  EXPECT_NE(with([](GateLimits& limits) { limits.soft_start = 0.0499; }).find("soft_start"),
            std::string::npos);
  EXPECT_NE(with([](GateLimits& limits) { limits.rise_max = 100'001; }).find("rise_max"),
            std::string::npos);
  EXPECT_NE(with([](GateLimits& limits) { limits.watchdog_ns = 1'000'000'001; }).find("watchdog"),
            std::string::npos);
}

}  // namespace
}  // namespace thimble::driver::zero_force_test
