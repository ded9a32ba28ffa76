// The speed limit of the gate does not depend on the filter of the velocity that laws get.
#include <gtest/gtest.h>

#include "support/moved_arm.h"
#include "thimble/driver/device.h"

namespace thimble::driver::gate_speed_test {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

/// Result of a run with an accelerating tip.
struct Outcome {
  Fault fault = Fault::kNone;
  double speed = 0;  ///< Speed when the force was switched off, or at the end, m/s.
};

/// Accelerates the tip to 6 m/s within 0.3 s, its velocity filtered at `corner`, Hz.
Outcome accelerate(double corner) {
  support::Moved moved;
  DeviceSettings settings = support::moved_settings();
  settings.velocity_corner_frequency = corner;
  auto device = Device::open(std::make_unique<support::MovedArm>(moved), settings, 0);
  EXPECT_TRUE(device);
  EXPECT_TRUE((*device)->activate());
  Outcome run;
  for (std::int64_t tick = 0; tick < 300; ++tick) {
    run.speed = 20e-3 * static_cast<double>(tick);
    moved.p_BT.x() += 1e-3 * run.speed;
    (*device)->read(tick * kPeriod_ns, tick * kPeriod_ns);
    (*device)->write({.f_T_W = {0, 1, 0}, .touch = {}});
    run.fault = (*device)->fault();
    if (run.fault != Fault::kNone) return run;
  }
  return run;
}

class GateSpeedTest : public ::testing::TestWithParam<double> {};

TEST_P(GateSpeedTest, SlowUserFilterDoesNotHideSpeed) {
  const Outcome run = accelerate(GetParam());
  EXPECT_EQ(run.fault, Fault::kOverSpeed) << "at " << run.speed << " m/s";
  EXPECT_LT(run.speed, 3.2);
  EXPECT_GT(run.speed, 2.9);
}

INSTANTIATE_TEST_SUITE_P(Corners, GateSpeedTest,
                         ::testing::Values(1e-6, 0.01, 1.0, 20.0, 99.0, 100.0, 500.0, 0.0));

TEST(GateSpeedOfVendorArms, SlowUserFilterDoesNotHideSpeed) {
  // An arm that reports zero velocity.
  class StillArm final : public ArmLink {
   public:
    explicit StillArm(support::Moved& moved) noexcept : arm_(moved) {}
    const ArmTraits& traits() const noexcept override { return traits_; }
    LinkRead read(ArmSample& sample, std::int64_t deadline_ns) noexcept override {
      return arm_.read(sample, deadline_ns);
    }
    LinkWrite write(const GatedForce& force, const ArmSample& sample,
                    const Eigen::Matrix3d& R_WB) noexcept override {
      return arm_.write(force, sample, R_WB);
    }

   private:
    support::MovedArm arm_;
    ArmTraits traits_{.has_velocity = true};
  };
  support::Moved moved;
  DeviceSettings settings = support::moved_settings();
  settings.velocity_corner_frequency = 0.01;
  auto device = Device::open(std::make_unique<StillArm>(moved), settings, 0);
  ASSERT_TRUE(device);
  ASSERT_TRUE((*device)->activate());
  double speed = 0;
  for (std::int64_t tick = 0; tick < 300 && (*device)->fault() == Fault::kNone; ++tick) {
    speed = 20e-3 * static_cast<double>(tick);
    moved.p_BT.x() += 1e-3 * speed;
    (*device)->read(tick * kPeriod_ns, tick * kPeriod_ns);
    (*device)->write({.f_T_W = {0, 1, 0}, .touch = {}});
  }
  EXPECT_EQ((*device)->fault(), Fault::kOverSpeed);
  EXPECT_LT(speed, 3.2);
}

}  // namespace
}  // namespace thimble::driver::gate_speed_test
