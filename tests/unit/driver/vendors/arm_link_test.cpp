#include "thimble/driver/arm_link.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>
#include <type_traits>

#include "support/boards/scripted_transport.h"
#include "support/pose_arm.h"
#include "support/vintage_arm.h"
#include "thimble/driver/device.h"
#include "thimble/driver/wire_link.h"

namespace thimble::driver {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// True if a link accepts `Force` as the force to send.
template <class Force>
constexpr bool takes(const Force* = nullptr) {
  return requires(ArmLink & link, const Force& force, const ArmSample& sample, const Matrix3d& R) {
    link.write(force, sample, R);
  };
}

TEST(ArmLink, AcceptsOnlyForcesFromTheGate) {
  static_assert(takes<GatedForce>());
  static_assert(!takes<Vector3d>());
  static_assert(!takes<ForceCommand>());
  static_assert(!takes<MotorCurrents>());
  // Only the gate can create a gated force that is not zero, neither from a force nor from another
  // gated force.
  static_assert(!std::is_constructible_v<GatedForce, Vector3d>);
  static_assert(!std::is_convertible_v<Vector3d, GatedForce>);
  static_assert(!std::is_aggregate_v<GatedForce>);
  static_assert(!std::is_assignable_v<decltype(std::declval<GatedForce&>().f_T_W()), Vector3d>);
  EXPECT_TRUE(GatedForce().f_T_W().isZero(0));
}

/// A device whose arm reports poses and accepts forces; its base is rotated by 90 degrees.
class PoseArmTest : public ::testing::Test {
 protected:
  DeviceSettings settings() const {
    DeviceSettings settings = support::vintage_settings();
    settings.R_WB = Eigen::AngleAxisd(std::numbers::pi / 2, Vector3d::UnitZ()).toRotationMatrix();
    settings.p_WB = {0.1, 0.2, 0.3};
    settings.motion = {.mass = 0.1, .delay_ticks = 0};
    return settings;
  }

  void open(const DeviceSettings& settings) {
    auto opened = Device::open(std::make_unique<support::PoseLink>(arm_, clock_), settings, 0);
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
    ASSERT_TRUE(device_->activate());
  }

  const DeviceState& tick(const Vector3d& f_T_W) {
    clock_.sleep_until_ns(++ticks_ * 1'000'000);
    const DeviceState& state = device_->read(clock_.now_ns(), clock_.now_ns());
    device_->write({.f_T_W = f_T_W, .touch = {}});
    return state;
  }
  support::PoseArm arm_from_now() const {
    support::PoseArm arm;
    arm.time_ns = clock_.now_ns();
    return arm;
  }
  void ticks(int count, const Vector3d& f_T_W) {
    for (int i = 0; i < count; ++i) tick(f_T_W);
  }

  support::PoseArm arm_;
  VirtualClock clock_;
  std::unique_ptr<Device> device_;
  std::int64_t ticks_ = 0;
};

TEST_F(PoseArmTest, LawGetsMeasuredValuesInTheWorldFrame) {
  arm_.R_BT = Eigen::AngleAxisd(0.3, Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  arm_.p_BH = {0.01, 0, 0};
  arm_.buttons = 5;
  open(settings());
  ticks(20, {0, 0, 0});
  arm_.advance_to(clock_.now_ns());
  const DeviceState& state = device_->state();
  const Matrix3d R_WB = settings().R_WB;
  EXPECT_LT((state.p_WT - (Vector3d(0.1, 0.2, 0.3) + R_WB * arm_.p_BT)).norm(), 1e-15);
  // The velocity of the arm, not a difference of positions.
  EXPECT_GT(arm_.v_BT.norm(), 0.05);
  EXPECT_LT((state.v_WT - R_WB * arm_.v_BT).norm(), 1e-15);
  EXPECT_TRUE(state.has_orientation);
  EXPECT_LT((state.R_WT - R_WB * arm_.R_BT).norm(), 1e-6);
  EXPECT_EQ(state.R_WT, rotation_of(state.q_WT));
  EXPECT_TRUE(state.has_gripper);
  EXPECT_FLOAT_EQ(state.gripper, 0.012F);
  EXPECT_EQ(state.buttons, 5);
  EXPECT_EQ(state.q, Vector3d(0, 0, 0));
  // Positions replace counts, in steps of a micrometre.
  EXPECT_NEAR(state.counts[0], arm_.p_BT.x() * 1e6, 0.5);
}

TEST_F(PoseArmTest, GetsGatedForceInItsBaseAndReportsScale) {
  open(settings());
  ticks(400, {0, 1, 0});
  // The world's y axis is the arm's x axis.
  EXPECT_LT((arm_.f_T_B - Vector3d(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((device_->f_sent_W() - Vector3d(0, 1, 0)).norm(), 1e-12);
  // The gate limits to 5 N, the arm to 3 N.
  arm_.p_BH = {0, 0, 0.001};
  ticks(100, {0, 0, -7});
  EXPECT_NEAR(arm_.f_T_B.norm(), 3, 1e-12);
  EXPECT_NEAR(device_->f_sent_W().norm(), 3, 1e-12);
  EXPECT_EQ(device_->fault(), Fault::kNone);
  EXPECT_GT(device_->gate_counters().limited, 50u);
}

TEST_F(PoseArmTest, OpensSoftlyAndSendsZeroWheneverItIsIdle) {
  open(settings());
  EXPECT_TRUE(arm_.taken_B.front().isZero(0));
  tick({0, 4, 0});
  tick({0, 4, 0});
  EXPECT_LT(arm_.f_T_B.norm(), 0.1);  // the soft start reaches 5 N in 0.3 s
  ticks(400, {0, 4, 0});
  EXPECT_GT(arm_.f_T_B.norm(), 2.9);
  device_->deactivate();
  EXPECT_TRUE(arm_.f_T_B.isZero(0));
  EXPECT_TRUE(device_->zero_assured());
}

TEST_F(PoseArmTest, LostSilentOrRefusingArmHasItsFault) {
  const auto trouble = [&](bool support::PoseArm::*kind) {
    device_.reset();
    arm_ = arm_from_now();
    open(settings());
    ticks(350, {0, 1, 0});
    EXPECT_EQ(device_->fault(), Fault::kNone);
    arm_.*kind = true;
    ticks(30, {0, 1, 0});
    return device_->fault();
  };
  EXPECT_EQ(trouble(&support::PoseArm::lost), Fault::kTransportLost);
  EXPECT_TRUE(device_->lost());
  EXPECT_TRUE(device_->f_sent_W().isZero(0));
  EXPECT_EQ(trouble(&support::PoseArm::silent), Fault::kNoReports);
  EXPECT_TRUE(arm_.f_T_B.isZero(0)) << "a silent arm still gets zero force";
  EXPECT_EQ(trouble(&support::PoseArm::refuses), Fault::kRefused);
  // After a refused message the previous force still acts, and it is reported.
  EXPECT_NEAR(arm_.f_T_B.norm(), 1, 1e-9);
  EXPECT_NEAR(device_->f_sent_W().norm(), 1, 1e-9);
  EXPECT_FALSE(device_->zero_assured());
  arm_.refuses = false;
  EXPECT_TRUE(device_->insist_on_zero(clock_));
  EXPECT_TRUE(arm_.f_T_B.isZero(0));
}

TEST_F(PoseArmTest, OldPositionsUnderAForceAreDetected) {
  open(settings());
  arm_.p_BH = {0.05, 0, 0};  // a hand motion
  ticks(60, {0, 0, 0.5});
  ticks(40, {0, 0, 1});
  EXPECT_GT(arm_.v_BT.norm(), 0.2);
  arm_.stuck = true;
  ticks(60, {0, 0, 1});
  EXPECT_EQ(device_->fault(), Fault::kCountsUnchanged);
}

TEST_F(PoseArmTest, SpeedLimitCoversTheReportedSpeed) {
  open(settings());
  ticks(10, {0, 0, 0});
  arm_.v_BT = {4, 0, 0};  // reported by the arm, beyond 3 m/s
  arm_.stiffness = arm_.damping = 0;
  ticks(2, {0, 0, 0});
  EXPECT_EQ(device_->fault(), Fault::kOverSpeed);
}

TEST_F(PoseArmTest, SpeedLimitHoldsIfTheArmReportsZeroSpeed) {
  arm_.reports_no_velocity = true;
  arm_.stiffness = arm_.damping = 0;
  open(settings());
  ticks(10, {0, 0, 0});
  EXPECT_EQ(device_->fault(), Fault::kNone);
  for (int i = 0; i < 40 && device_->fault() == Fault::kNone; ++i) {
    arm_.v_BT.x() += 0.2;  // up to 8 m/s, where 3 are allowed
    tick({0, 0, 0});
  }
  EXPECT_EQ(device_->fault(), Fault::kOverSpeed);
  EXPECT_LT(arm_.v_BT.x(), 4);
  EXPECT_TRUE(device_->state().v_WT.isZero(0));
}

TEST_F(PoseArmTest, OrientationThatIsNotFiniteIsAFault) {
  open(settings());
  ticks(10, {0, 0, 0});
  const Matrix3d before = device_->state().R_WT;
  arm_.R_BT.setConstant(std::numeric_limits<double>::quiet_NaN());
  ticks(2, {0, 0, 1});
  EXPECT_EQ(device_->fault(), Fault::kStateNotFinite);
  EXPECT_EQ(device_->state().R_WT, before);
  EXPECT_TRUE(arm_.f_T_B.isZero(0));
}

TEST_F(PoseArmTest, ReturnsOnlyThroughALinkToTheSameArm) {
  open(settings());
  ticks(350, {0, 1, 0});
  arm_.lost = true;
  ticks(5, {0, 1, 0});
  ASSERT_EQ(device_->fault(), Fault::kTransportLost);

  support::Wire wire;
  const auto other = device_->offer(
      std::make_unique<WireLink>(std::make_unique<support::ScriptedTransport>(wire),
                                 std::make_unique<hfab::HfabArm>(support::vintage_model())));
  ASSERT_FALSE(other);
  EXPECT_NE(other.error().message.find("differs from the one that was disconnected"),
            std::string::npos);

  support::PoseArm again = arm_from_now();
  ASSERT_TRUE(device_->offer(std::make_unique<support::PoseLink>(again, clock_)));
  ticks(3, {0, 1, 0});
  EXPECT_FALSE(device_->lost());
  EXPECT_EQ(device_->wire_counters().replugged, 1u);
  EXPECT_TRUE(again.f_T_B.isZero(0)) << "no force was requested yet";
  device_->ask_to_activate();
  ticks(400, {0, 1, 0});
  EXPECT_NEAR(again.f_T_B.norm(), 1, 1e-9);
  EXPECT_EQ(device_->fault(), Fault::kNone);
  device_.reset();  // before the arm, which it uses in its destructor
}

TEST_F(PoseArmTest, RefusesHeatSettingsWithoutMotors) {
  DeviceSettings warm = settings();
  warm.heat = {.continuous_current = {1, 1, 1}, .time_constant = {60, 60, 60}};
  const auto opened = Device::open(std::make_unique<support::PoseLink>(arm_, clock_), warm, 0);
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("does not report its motor currents"), std::string::npos);
}

TEST_F(PoseArmTest, AccountsForTheWorkOnTheHand) {
  // A wall that gives energy: its spring is stiffer on the way out. The account of the gate must
  // equal the force of the arm times its displacement.
  DeviceSettings guarded = settings();
  guarded.energy = {.stage = EnergyStage::kPassivity,
                    .mass = 0.1,
                    .allowance = 1,  // only recorded
                    .reservoir = 10};
  open(guarded);
  ticks(310, {0, 0, 0});
  double work = 0;
  for (int i = 0; i < 400; ++i) {
    arm_.p_BH = Vector3d(0, 0, -0.01 * std::sin(0.02 * i));
    const Vector3d before = arm_.p_BT, held = arm_.f_T_B;
    const double z = device_->state().p_WT.z() - 0.3;
    tick({0, 0, z < 0 ? -(device_->state().v_WT.z() > 0 ? 400 : 100) * z : 0});
    work += held.dot(arm_.p_BT - before);
  }
  ASSERT_EQ(device_->fault(), Fault::kNone);
  EXPECT_GT(work, 0.001) << "without this work the test could not fail";
  EXPECT_NEAR(device_->gate().energy(), -work, 1e-9);
}

TEST_F(PoseArmTest, EnergyStageDampsItLikeAnyArm) {
  const auto given = [&](EnergyStage stage) {
    device_.reset();
    arm_ = arm_from_now();
    DeviceSettings guarded = settings();
    guarded.energy = {.stage = stage,
                      .mass = 0.1,
                      .allowance = 0.002,
                      .reservoir = 0.01,
                      .onset = 0.002,
                      .slope = 0};
    open(guarded);
    ticks(310, {0, 0, 0});
    arm_.p_BH = {0, 0, -0.004};
    double work = 0;
    for (int i = 0; i < 1500; ++i) {
      const Vector3d before = arm_.p_BT, held = arm_.f_T_B;
      // Stiff and delayed by a few ticks: an active wall.
      const double z = device_->state().p_WT.z() - 0.3;
      const double away = device_->state().v_WT.z() > 0 ? 900 : 200;
      tick({0, 0, z < 0 ? -away * z : 0});
      work += held.dot(arm_.p_BT - before);
    }
    return work;
  };
  const double free = given(EnergyStage::kNone), damped = given(EnergyStage::kPassivity);
  EXPECT_GT(free, 0.02);
  EXPECT_LT(damped, 0.5 * free);
  EXPECT_GT(device_->gate_counters().damped, 0u);
}

}  // namespace
}  // namespace thimble::driver
