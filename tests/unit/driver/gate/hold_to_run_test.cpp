#include <gtest/gtest.h>

#include "support/moved_arm.h"
#include "thimble/driver/device.h"

namespace thimble::driver::hold_to_run_test {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

class HoldToRunTest : public ::testing::Test {
 protected:
  void open(const HoldToRun& hold) {
    DeviceSettings settings = support::moved_settings();
    settings.hold = hold;
    auto opened = Device::open(std::make_unique<support::MovedArm>(moved_), settings, 0);
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
    ASSERT_TRUE(device_->activate());
  }

  /// Runs ticks with a requested force of 1 N; returns the acting force, N.
  double run(int ticks) {
    for (int i = 0; i < ticks; ++i) {
      now_ns_ += kPeriod_ns;
      device_->read(now_ns_, now_ns_);
      device_->write({.f_T_W = {1, 0, 0}, .touch = {}});
    }
    return moved_.f_T_B.x();
  }

  support::Moved moved_;
  std::int64_t now_ns_ = 0;
  std::unique_ptr<Device> device_;
};

TEST_F(HoldToRunTest, OpenButtonMeansNoForce) {
  open({.buttons = 1});
  EXPECT_EQ(run(1000), 0);
  EXPECT_EQ(device_->stage(), DeviceStage::kWaiting);
  EXPECT_EQ(device_->fault(), Fault::kNone);
}

TEST_F(HoldToRunTest, HeldButtonLetsForceRiseSlowly) {
  open({.buttons = 1});
  run(100);
  moved_.buttons = 1;
  EXPECT_LT(run(20), 0.35);
  EXPECT_EQ(run(400), 1);
  EXPECT_EQ(device_->stage(), DeviceStage::kActive);
}

TEST_F(HoldToRunTest, ReleasedButtonEndsForceInOneTick) {
  open({.buttons = 1});
  run(10);
  moved_.buttons = 1;
  ASSERT_EQ(run(500), 1);
  moved_.buttons = 0;
  EXPECT_EQ(run(1), 0);
  moved_.buttons = 1;
  EXPECT_LT(run(20), 0.35) << "the soft start applies again";
  EXPECT_EQ(run(400), 1);
}

TEST_F(HoldToRunTest, StuckButtonIsIgnored) {
  moved_.buttons = 1;
  open({.buttons = 1});
  EXPECT_EQ(run(1000), 0);
  moved_.buttons = 0;
  run(1);
  moved_.buttons = 1;
  EXPECT_EQ(run(500), 1);
}

TEST_F(HoldToRunTest, OtherButtonsAreIgnored) {
  open({.buttons = 2});
  run(1);
  moved_.buttons = 1;
  EXPECT_EQ(run(500), 0);
  moved_.buttons = 3;
  EXPECT_EQ(run(500), 1);
}

TEST_F(HoldToRunTest, ActivationNeedsTheButtonSeenReleased) {
  open({.buttons = 1});
  run(10);
  moved_.buttons = 1;
  ASSERT_EQ(run(500), 1);
  device_->deactivate();
  ASSERT_TRUE(device_->activate());
  EXPECT_EQ(run(500), 0);
}

TEST_F(HoldToRunTest, CallersInputLapsesByItself) {
  open({.by_caller = true});
  EXPECT_EQ(run(100), 0);
  for (int i = 0; i < 20; ++i) {
    device_->hold_until(now_ns_ + 50 * kPeriod_ns);
    run(20);
  }
  ASSERT_EQ(run(1), 1);
  EXPECT_EQ(run(60), 0) << "the caller no longer confirms that it is held";
}

TEST_F(HoldToRunTest, BothInputsMustBeHeld) {
  open({.buttons = 1, .by_caller = true});
  run(1);
  moved_.buttons = 1;
  EXPECT_EQ(run(100), 0);
  device_->hold_until(now_ns_ + 1000 * kPeriod_ns);
  EXPECT_EQ(run(500), 1);
}

TEST_F(HoldToRunTest, FaultsLatchWhileItWaits) {
  open({.buttons = 1});
  run(10);
  device_->trip(Fault::kOtherArm);
  moved_.buttons = 1;
  EXPECT_EQ(run(500), 0);
  EXPECT_EQ(device_->stage(), DeviceStage::kFault);
}

TEST_F(HoldToRunTest, IsNotRequiredUnlessSet) {
  open({});
  EXPECT_EQ(run(500), 1);
  EXPECT_EQ(device_->stage(), DeviceStage::kActive);
}

}  // namespace
}  // namespace thimble::driver::hold_to_run_test
