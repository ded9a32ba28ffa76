#include "gate/workspace_walls.h"

#include <gtest/gtest.h>

#include <cmath>

#include "support/moved_arm.h"
#include "thimble/driver/device.h"

namespace thimble::driver::workspace_walls_test {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

/// A device with walls at 0.1 m around the origin, after its soft start.
class WorkspaceWallsTest : public ::testing::Test {
 protected:
  void open(const Eigen::Vector3d& p_WT) {
    moved_.p_BT = p_WT;
    DeviceSettings settings = support::moved_settings();
    settings.walls.min_W = {-0.1, -0.1, -0.1};
    settings.walls.max_W = {0.1, 0.1, 0.1};
    auto opened = Device::open(std::make_unique<support::MovedArm>(moved_), settings, 0);
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
    ASSERT_TRUE(device_->activate());
    for (int i = 0; i < 400; ++i) tick(p_WT, {0, 0, 0});
  }

  void tick(const Eigen::Vector3d& p_WT, const Eigen::Vector3d& f_W) {
    now_ns_ += kPeriod_ns;
    moved_.p_BT = p_WT;
    device_->read(now_ns_, now_ns_);
    device_->write({.f_T_W = f_W, .touch = {}});
  }

  /// Moves the tip to a point within `ticks`, under the given force; stops on a fault.
  void move(const Eigen::Vector3d& to, int ticks, const Eigen::Vector3d& f_W) {
    const Eigen::Vector3d from = moved_.p_BT;
    for (int i = 1; i <= ticks && device_->fault() == Fault::kNone; ++i) {
      tick(from + (to - from) * i / ticks, f_W);
    }
  }

  support::Moved moved_;
  std::int64_t now_ns_ = 0;
  std::unique_ptr<Device> device_;
};

TEST_F(WorkspaceWallsTest, ChangeNoForceInside) {
  open({0, 0, 0});
  move({0.1, -0.1, 0.1}, 200, {0.3, 0.1, -0.7});
  EXPECT_EQ(device_->f_sent_W(), Eigen::Vector3d(0.3, 0.1, -0.7));
  EXPECT_EQ(device_->fault(), Fault::kNone);
}

TEST_F(WorkspaceWallsTest, PushBackOutside) {
  open({0, 0, 0});
  move({0.11, 0, 0}, 200, {0, 0, 0});
  for (int i = 0; i < 50; ++i) tick({0.11, 0, 0}, {0, 0, 0});
  EXPECT_NEAR(device_->f_sent_W().x(), -2, 1e-9);  // 200 N/m
  EXPECT_EQ(device_->f_sent_W().y(), 0);
}

TEST_F(WorkspaceWallsTest, TakeAwayForceThatPushesOut) {
  open({0, 0, 0});
  move({0.115, 0, 0}, 200, {4, 1, 0});
  for (int i = 0; i < 50; ++i) tick({0.115, 0, 0}, {4, 1, 0});
  EXPECT_NEAR(device_->f_sent_W().x(), -3, 1e-9);
  EXPECT_NEAR(device_->f_sent_W().y(), 1, 1e-9);
}

// A force that ended abruptly at the wall would push a loosely held tip to and fro across it.
TEST_F(WorkspaceWallsTest, ForceThatPushesOutFadesWithoutSteps) {
  open({0, 0, 0});
  move({0.0999, 0, 0}, 500, {4, 0, 0});
  double before = device_->f_sent_W().x();
  EXPECT_EQ(before, 4);
  for (int i = 1; i <= 200; ++i) {
    for (int k = 0; k < 20; ++k)
      tick({0.0999 + 1e-4 * i, 0, 0}, {4, 0, 0});  // the tip comes to rest
    const double now = device_->f_sent_W().x();
    EXPECT_LE(now, before);
    EXPECT_GT(now, before - 0.06) << i;  // (200 + 4 / 0.015) N/m over 0.1 mm
    before = now;
  }
  EXPECT_LT(before, -3.9);
}

TEST_F(WorkspaceWallsTest, KeepForceThatPushesIn) {
  open({0, 0, 0});
  move({0.11, 0, 0}, 200, {-1, 0, 0});
  for (int i = 0; i < 50; ++i) tick({0.11, 0, 0}, {-1, 0, 0});
  EXPECT_NEAR(device_->f_sent_W().x(), -3, 1e-9);
}

TEST_F(WorkspaceWallsTest, SwitchForceOffFarOutside) {
  open({0, 0, 0});
  move({0.128, 0, 0}, 200, {0, 0, 0});
  EXPECT_EQ(device_->fault(), Fault::kNone);
  move({0.132, 0, 0}, 20, {0, 0, 0});
  EXPECT_EQ(device_->fault(), Fault::kOutsideWorkspace);
  EXPECT_EQ(device_->f_sent_W(), Eigen::Vector3d(0, 0, 0));
}

TEST_F(WorkspaceWallsTest, StayOffAfterReturnUntilActivated) {
  open({0, 0, 0});
  move({0.2, 0, 0}, 200, {0, 0, 0});
  ASSERT_EQ(device_->fault(), Fault::kOutsideWorkspace);
  for (int i = 0; i < 500; ++i) tick({0, 0, 0}, {1, 0, 0});
  EXPECT_EQ(moved_.f_T_B, Eigen::Vector3d(0, 0, 0));
  ASSERT_TRUE(device_->activate());
  for (int i = 0; i < 500; ++i) tick({0, 0, 0}, {1, 0, 0});
  EXPECT_EQ(moved_.f_T_B, Eigen::Vector3d(1, 0, 0));
}

TEST_F(WorkspaceWallsTest, DoNotPushAnArmThatStartsOutside) {
  open({-0.2, 0, 0});
  for (int i = 0; i < 400; ++i) tick({-0.2, 0, 0}, {1, 0, 0});
  EXPECT_EQ(device_->f_sent_W(), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(device_->fault(), Fault::kNone);
  // Beyond its start point the wall acts.
  move({-0.21, 0, 0}, 100, {0, 0, 0});
  for (int i = 0; i < 50; ++i) tick({-0.21, 0, 0}, {0, 0, 0});
  EXPECT_NEAR(device_->f_sent_W().x(), 2, 1e-9);
}

TEST_F(WorkspaceWallsTest, StayBelowTheLimitOfTheForce) {
  open({0, 0, 0});
  move({0.128, 0, 0}, 200, {0, 5, 0});
  EXPECT_EQ(device_->fault(), Fault::kNone);
  EXPECT_LE(device_->f_sent_W().norm(), 5 + 1e-12);
  EXPECT_LT(device_->f_sent_W().x(), -2);
}

TEST_F(WorkspaceWallsTest, DampOnlyOutwardMotion) {
  open({0, 0, 0});
  move({0.1, 0, 0}, 200, {0, 0, 0});
  move({0.11, 0, 0}, 20, {0, 0, 0});  // 0.5 m/s
  EXPECT_NEAR(device_->f_sent_W().x(), -2 - 0.5 * WallSettings::kDamping, 1e-6);
  move({0.12, 0, 0}, 100, {0, 0, 0});
  move({0.11, 0, 0}, 20, {0, 0, 0});
  EXPECT_NEAR(device_->f_sent_W().x(), -2, 1e-6);
}

TEST_F(WorkspaceWallsTest, CountTheTicksInWhichTheyPush) {
  open({0, 0, 0});
  EXPECT_EQ(device_->wall_counters().pushed, 0U);
  std::uint64_t behind = 0;
  const auto at = [&](double x) {
    tick({x, 0, 0}, {0, 0, 0});
    behind += device_->state().p_WT.x() > 0.1;
  };
  for (int i = 1; i <= 220; ++i) at(5e-4 * i);
  for (int i = 0; i < 50; ++i) at(0.11);
  for (int i = 1; i <= 40; ++i) at(0.11 - 5e-4 * i);
  EXPECT_GT(behind, 60U);
  EXPECT_EQ(device_->wall_counters().pushed, behind);
}

TEST_F(WorkspaceWallsTest, KeepTheirStrongestForce) {
  open({0, 0, 0});
  move({0, 0, -0.12}, 400, {0, 0, 0});
  for (int i = 0; i < 50; ++i) tick({0, 0, -0.12}, {0, 0, 0});
  for (int i = 0; i < 50; ++i) tick({0, 0, -0.105}, {0, 0, 0});
  EXPECT_NEAR(device_->wall_counters().f_W.z(), 1, 1e-9);
  EXPECT_GE(device_->wall_counters().f_strongest_W.z(), 4 - 1e-9);
}

TEST_F(WorkspaceWallsTest, AreOffUnlessSet) {
  auto opened =
      Device::open(std::make_unique<support::MovedArm>(moved_), support::moved_settings(), 0);
  ASSERT_TRUE(opened);
  device_ = std::move(opened).value();
  ASSERT_TRUE(device_->activate());
  for (int i = 0; i < 400; ++i) tick({0, 0, 0}, {1, 0, 0});
  move({9, 0, 0}, 9000, {1, 0, 0});
  EXPECT_EQ(device_->f_sent_W(), Eigen::Vector3d(1, 0, 0));
}

TEST_F(WorkspaceWallsTest, AreRefusedIfInvalid) {
  DeviceSettings settings = support::moved_settings();
  for (const double corner : {0.2, static_cast<double>(NAN)}) {
    settings.walls.min_W = {corner, 0, 0};
    settings.walls.max_W = {0.1, 0, 0};
    const auto opened = Device::open(std::make_unique<support::MovedArm>(moved_), settings, 0);
    ASSERT_FALSE(opened);
    EXPECT_NE(opened.error().message.find("workspace"), std::string::npos);
  }
}

}  // namespace
}  // namespace thimble::driver::workspace_walls_test
