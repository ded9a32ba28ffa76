// A board that restarts on a live wire counts from zero at its present pose: no force before the
// home pose is confirmed.

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <memory>

#include "arms/falcon/falcon_arm.h"
#include "arms/hfab/hfab_report.h"
#include "arms/hfab/hfab_wire.h"
#include "support/boards/scripted_transport.h"
#include "support/pose_arm.h"
#include "support/vintage_arm.h"
#include "thimble/driver/wire_link.h"

namespace thimble::driver::home_needed_test {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;
constexpr std::array<std::int16_t, 3> kAway{1500, 800, 0};  // about 45 mm from the home pose

/// The vintage arm with absolute encoders.
struct AbsoluteWire : hfab::ReportWire {
  static constexpr bool kFindsZero = true;
};
using AbsoluteArm = WireArm<AbsoluteWire, SerialArm>;

/// An arm that pushes, on a scripted wire: `tick` has a report, `missing` has none.
class HomeNeeded : public ::testing::Test {
 protected:
  void open(std::unique_ptr<const Arm> arm) {
    device_.reset();
    wire_ = {};
    wire_.to_host.push_back(report(kAway));
    auto opened =
        Device::open(std::make_unique<WireLink>(std::make_unique<support::ScriptedTransport>(wire_),
                                                std::move(arm)),
                     support::vintage_settings(), now_ns_);
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
  }
  void push() {
    ASSERT_TRUE(device_->activate());
    for (int k = 0; k < 400; ++k) tick(kAway);
    ASSERT_NEAR(device_->f_sent_W().norm(), 0.5, 1e-9);
  }
  void SetUp() override {
    open(std::make_unique<hfab::HfabArm>(support::vintage_model()));
    push();
  }

  static std::vector<std::byte> report(const std::array<std::int16_t, 3>& counts) {
    hfab::InputReport input;
    input.counts = {counts[0], counts[1], counts[2], 0, 0, 0};
    const auto bytes = hfab::encode_input(input);
    return {bytes.begin(), bytes.end()};
  }
  void tick(const std::array<std::int16_t, 3>& counts) {
    wire_.to_host.push_back(report(counts));
    missing();
  }
  void missing() {
    now_ns_ += kPeriod_ns;
    device_->read(now_ns_, now_ns_);
    device_->write({.f_T_W = {0, 0.5, 0}, .touch = {}});
  }
  double force() const { return device_->f_sent_W().norm(); }

  /// Expects that forces require a home check.
  void expect_home_needed() {
    EXPECT_TRUE(device_->home_needed());
    EXPECT_FALSE(device_->activate());
    device_->ask_to_activate();
    for (int k = 0; k < 400; ++k) tick({0, 0, 0});
    EXPECT_EQ(force(), 0) << "its tip and its Jacobian are wrong";
    device_->ask_to_activate(HomeCheck::kPassed);
    for (int k = 0; k < 400; ++k) tick({0, 0, 0});
    EXPECT_NEAR(force(), 0.5, 1e-9);
    EXPECT_FALSE(device_->home_needed());
  }

  support::Wire wire_;
  std::int64_t now_ns_ = 0;
  std::unique_ptr<Device> device_;
};

TEST_F(HomeNeeded, AfterASilence) {
  for (int k = 0; k < 500; ++k) missing();
  EXPECT_EQ(device_->fault(), Fault::kNoReports);
  EXPECT_EQ(device_->link_state(), LinkState::kSilent);
  tick({0, 0, 0});
  EXPECT_EQ(device_->link_state(), LinkState::kConnected);
  expect_home_needed();
}

TEST_F(HomeNeeded, AfterASilenceWithRefusedMessages) {
  tick(kAway);
  wire_.refusals = 1000;
  for (int k = 0; k < 500; ++k) missing();
  wire_.refusals = 0;
  EXPECT_EQ(device_->link_state(), LinkState::kSilent);
  expect_home_needed();
}

TEST_F(HomeNeeded, AfterAJumpAcrossAGapOfAnyLength) {
  for (int gap = 1; gap <= 19; ++gap) {
    SetUp();
    for (int k = 0; k < gap; ++k) missing();
    tick({0, 0, 0});
    tick({0, 0,
          0});  // short gaps: the first report is dropped like one from a disturbed encoder line
    EXPECT_EQ(device_->fault(), Fault::kCountsJumped) << gap;
    EXPECT_EQ(force(), 0) << gap;
    EXPECT_TRUE(device_->home_needed()) << gap;
  }
  expect_home_needed();
}

TEST_F(HomeNeeded, AfterAJumpWithoutAGap) {
  tick({0, 0, 0});
  tick({0, 0, 0});
  EXPECT_EQ(device_->fault(), Fault::kCountsJumped);
  expect_home_needed();
}

TEST_F(HomeNeeded, NotAfterAMotionAcrossAGap) {
  // 0.5 m/s at the tip: about 15 counts per millisecond.
  std::int16_t yaw = kAway[0];
  for (int k = 0; k < 50; ++k) tick({yaw = static_cast<std::int16_t>(yaw - 15), kAway[1], 0});
  for (int k = 0; k < 15; ++k) missing();
  yaw = static_cast<std::int16_t>(yaw - 15 * 15);
  for (int k = 0; k < 10; ++k) tick({yaw = static_cast<std::int16_t>(yaw - 15), kAway[1], 0});
  EXPECT_EQ(device_->fault(), Fault::kNone);
  EXPECT_FALSE(device_->home_needed());
}

TEST_F(HomeNeeded, NotAfterOneDisturbedReport) {
  tick({0, 0, 0});
  for (int k = 0; k < 10; ++k) tick(kAway);
  EXPECT_EQ(device_->fault(), Fault::kNone);
  EXPECT_FALSE(device_->home_needed());
}

TEST_F(HomeNeeded, NotByAbsoluteEncoders) {
  open(std::make_unique<AbsoluteArm>(support::vintage_model()));
  push();
  for (int k = 0; k < 500; ++k) missing();
  EXPECT_EQ(device_->fault(), Fault::kNoReports);
  for (int k = 0; k < 10; ++k) tick(kAway);
  EXPECT_FALSE(device_->home_needed());
  EXPECT_TRUE(device_->activate());
}

TEST_F(HomeNeeded, NotByABoardThatFindsItsOwnZero) {
  const falcon::FalconArm arm(falcon::falcon_model());
  EXPECT_FALSE(arm.zero_at_power_on());
}

TEST_F(HomeNeeded, NotByAnArmWhosePoseItsVendorReports) {
  VirtualClock clock;
  support::PoseArm arm;
  auto opened =
      Device::open(std::make_unique<support::PoseLink>(arm, clock), support::vintage_settings(), 0);
  ASSERT_TRUE(opened);
  EXPECT_FALSE((*opened)->traits().zero_at_power_on);
}

TEST_F(HomeNeeded, AfterASilenceBeforeForces) {
  open(std::make_unique<hfab::HfabArm>(support::vintage_model()));
  for (int k = 0; k < 30; ++k) {
    now_ns_ += kPeriod_ns;
    device_->idle(now_ns_, now_ns_);
  }
  EXPECT_EQ(device_->fault(), Fault::kNone);
  EXPECT_EQ(device_->link_state(), LinkState::kSilent);
  expect_home_needed();
}

TEST_F(HomeNeeded, NotAfterTheCallerPaused) {
  open(std::make_unique<hfab::HfabArm>(support::vintage_model()));
  for (const std::int64_t away_ns : {1'000'000'000, 50'000'000}) {
    now_ns_ += away_ns;
    device_->idle(now_ns_, now_ns_);  // the report has not arrived yet
    now_ns_ += kPeriod_ns;
    wire_.to_host.push_back(report({0, 0, 0}));  // the hand moved the arm meanwhile
    device_->idle(now_ns_, now_ns_);
    EXPECT_FALSE(device_->home_needed());
    EXPECT_EQ(device_->link_state(), LinkState::kConnected);
  }
}

TEST_F(HomeNeeded, NotIfTheCallerSendsNothing) {
  // An arm that only answers messages is silent then.
  tick(kAway);
  wire_.to_host.push_back(report(kAway));
  for (int k = 0; k < 30; ++k) {
    now_ns_ += kPeriod_ns;
    device_->read(now_ns_, now_ns_);
  }
  EXPECT_EQ(device_->fault(), Fault::kNoReports);
  EXPECT_FALSE(device_->home_needed());
}

}  // namespace
}  // namespace thimble::driver::home_needed_test
