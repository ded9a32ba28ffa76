#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>

#include "arm_table.h"
#include "board/sim_transport.h"
#include "support/random.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/device.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/wire_link.h"
#include "vintage_simulation.h"

// The simulated arm with one or two motors, through its board's reports and the driver.
namespace thimble::device_sim {
namespace {

using driver::ArmKind;
using driver::ArmModel;
using Eigen::Vector3d;

/// The third generation of the Haply 2DIY, with a motor of 0.123 N m.
ArmModel five_bar() {
  ArmModel model;
  model.geometry = driver::FiveBarArm{
      .base = 0.038, .crank_1 = 0.07, .crank_2 = 0.07, .distal_1 = 0.09, .distal_2 = 0.09};
  model.drives = {driver::MotorDrive{.ratio = 1, .torque_constant = 0.123, .current_max = 1},
                  driver::MotorDrive{.ratio = 1, .torque_constant = 0.123, .current_max = 1},
                  driver::absent_motor()};
  model.encoders = {driver::JointEncoder{.counts_per_motor_turn = 4880, .home_counts = 2277},
                    driver::JointEncoder{.counts_per_motor_turn = 4880, .home_counts = 163},
                    driver::absent_encoder()};
  return model;
}

/// A Hapkit with the published radii and a motor of 0.03 N m.
ArmModel paddle() {
  ArmModel model;
  model.geometry = driver::PaddleArm{.handle = 0.09};
  model.drives = {driver::MotorDrive{.ratio = 14.8, .torque_constant = 0.03, .current_max = 1},
                  driver::absent_motor(), driver::absent_motor()};
  model.encoders = {driver::JointEncoder{.counts_per_motor_turn = 4096}, driver::absent_encoder(),
                    driver::absent_encoder()};
  return model;
}

/// Two straight axes on pulleys of 10 and 20 mm.
ArmModel table() {
  ArmModel model = five_bar();
  model.geometry = driver::CartesianArm{.radius = {0.01, 0.02, 1}, .axes = 2};
  for (driver::JointEncoder& encoder : model.encoders) encoder.home_counts = 0;
  return model;
}

Vector3d middle_of(const ArmModel& model) {
  return std::holds_alternative<driver::FiveBarArm>(model.geometry) ? Vector3d(0, 0.09, 0)
                                                                    : Vector3d(0, 0, 0);
}

SimulatedArmSettings loose() {
  SimulatedArmSettings settings = free_arm();
  settings.motors.current_max = 1;
  return settings;
}

SimulatedArm arm_of(const ArmModel& model, const SimulatedArmSettings& settings,
                    const Vector3d& p_BH) {
  auto arm = SimulatedArm::make(model, settings, resting_at(p_BH));
  EXPECT_TRUE(arm) << arm.error().message;
  return std::move(arm).value();
}

/// The force at the tip is J^-T tau along the axes of the tip.
void expect_forces(const ArmModel& model) {
  SimulatedArm arm = arm_of(model, loose(), middle_of(model));
  arm.put_message(drive_message(400, -250, 700));  // the third output has no motor
  arm.advance_to(20'000'000);
  const auto q = driver::inverse(model.geometry, arm.plant().p_BT());
  ASSERT_TRUE(q);
  Vector3d p;
  Eigen::Matrix3d J;
  std::visit([&](const auto& build) { build.forward(*q, p, J); }, model.geometry);
  Vector3d tau(0, 0, 0);
  const Vector3d amperes(0.4, -0.25, 0.7);
  for (std::size_t i = 0; i < 3; ++i) {
    const driver::MotorDrive& drive = model.drives[i];
    tau[static_cast<Eigen::Index>(i)] =
        drive.sign * drive.ratio * drive.torque_constant * amperes[static_cast<Eigen::Index>(i)];
  }
  EXPECT_LT((J.transpose() * arm.plant().f_T_B() - tau).norm(), 1e-6 * tau.norm());
  EXPECT_EQ(arm.plant().f_T_B().z(), 0);
  EXPECT_EQ(arm.plant().p_BT().z(), 0);
}

TEST(ShortArmsSim, MotorsPushByTheTransposedJacobian) {
  expect_forces(five_bar());
  expect_forces(paddle());
  expect_forces(table());
}

TEST(ShortArmsSim, TipStaysOnItsAxes) {
  // A hand that wants to be elsewhere, with tremor and weight, on arms of every kind of plant.
  for (const ArmModel& model : {five_bar(), paddle(), table()}) {
    for (const int kind : {0, 1, 2}) {
      SimulatedArmSettings settings = phantom_like();
      settings.motors.current_max = 1;
      settings.hand.tremor_amplitude = 1e-4;
      settings.weight_B = {0.1, 0.2, -0.3};
      if (kind == 1) settings.drive_train.current_lag = 1e-3;
      if (kind == 2) settings.drive_train.coulomb = {1e-4, 1e-4, 0};
      const Vector3d middle = middle_of(model);
      auto path = HandPath::make(
          {{0.0, middle + Vector3d(0, 0, 0.03)}, {0.5, middle + Vector3d(0.01, 0.01, -0.05)}});
      auto made = SimulatedArm::make(model, settings, std::move(path).value(), 7);
      ASSERT_TRUE(made) << made.error().message;
      SimulatedArm arm = std::move(made).value();
      ASSERT_TRUE(arm.fix_mass(0.05, {1, 2, -9}));
      arm.put_message(drive_message(300, 300, 300));
      arm.advance_to(600'000'000);
      EXPECT_EQ(arm.plant().p_BT().z(), 0);
      EXPECT_EQ(arm.plant().v_BT().z(), 0);
      EXPECT_GT((arm.plant().p_BT() - middle).norm(), 1e-4);
      const bool on_line = driver::motor_count(model.geometry) == 1;
      EXPECT_TRUE(!on_line || arm.plant().p_BT().y() == 0);
    }
  }
}

TEST(ShortArmsSim, ReportsCountOnlyTheEncodersThatExist) {
  SimulatedArm arm = arm_of(paddle(), loose(), {0.01, 0, 0});
  const auto report = take(arm);
  ASSERT_TRUE(report);
  EXPECT_EQ(report->counts[0], std::lround(0.01 / 0.09 * 14.8 * 4096 / (2 * std::numbers::pi)));
  EXPECT_EQ(report->counts[1], 0);
  EXPECT_EQ(report->counts[2], 0);
}

/// Measures the work of the motors on the moving tip against the torques that the driver sent.
TEST(ShortArmsSim, WorkOfTorquesIsWorkOfTheForce) {
  for (const ArmModel& model : {five_bar(), paddle(), table()}) {
    SimulatedArm arm = arm_of(model, loose(), middle_of(model));
    double by_force = 0, by_torque = 0;
    Vector3d p = arm.plant().p_BT(), q = arm.plant().q();
    arm.put_message(drive_message(60, -40, 0));
    for (int ms = 1; ms <= 60; ++ms) {
      arm.advance_to(ms * std::int64_t{1'000'000});
      const Vector3d moved = arm.plant().p_BT() - p, turned = arm.plant().q() - q;
      Vector3d tau(0, 0, 0);
      for (std::size_t i = 0; i < 3; ++i) {
        const driver::MotorDrive& drive = model.drives[i];
        const auto k = static_cast<Eigen::Index>(i);
        tau[k] = drive.sign * drive.ratio * drive.torque_constant * arm.plant().currents()[k];
      }
      by_force += arm.plant().f_T_B().dot(moved);
      by_torque += tau.dot(turned);
      p += moved;
      q += turned;
    }
    EXPECT_GT(by_force, 1e-5);
    EXPECT_NEAR(by_torque, by_force, 0.02 * by_force);
  }
}

TEST(ShortArmsSim, LinksAreRefused) {
  SimulatedArmSettings settings = phantom_like();
  settings.links.inertia = {1e-4, 1e-4, 1e-4};
  const auto made = SimulatedArm::make(five_bar(), settings, resting_at({0, 0.09, 0}));
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find("serial arms only"), std::string::npos);
}

TEST(ShortArmsSim, StartOutOfReachIsRefused) {
  EXPECT_FALSE(SimulatedArm::make(five_bar(), phantom_like(), resting_at({0, 0.5, 0})));
  EXPECT_FALSE(SimulatedArm::make(paddle(), phantom_like(), resting_at({0.5, 0, 0})));
}

/// A wall across the whole space that pushes along (1, 1, 1).
struct Slope {
  driver::ForceCommand operator()(const driver::DeviceState&) noexcept {
    driver::ForceCommand command;
    command.f_T_W = {0.2, 0.2, 0.2};
    return command;
  }
  void operator()(const driver::TickRecord& record) noexcept {
    last = record;
    f_T_B = arm->plant().f_T_B();
  }
  const SimulatedArm* arm = nullptr;
  driver::TickRecord last;
  Vector3d f_T_B{0, 0, 0};
};

/// Runs a device on the simulated arm for half a second, with a base turned against the world.
void expect_projected(const ArmModel& model) {
  SimulatedArmSettings settings = phantom_like();
  settings.motors.current_max = 1;
  SimulatedArm arm = arm_of(model, settings, middle_of(model));
  driver::VirtualClock clock;
  driver::DeviceSettings of_device = support::vintage_settings();
  of_device.p_WB.setZero();
  of_device.R_WB << 0, 0, 1, 1, 0, 0, 0, 1, 0;  // x to y, y to z, z to x
  auto opened = driver::Device::open(
      std::make_unique<driver::WireLink>(std::make_unique<SimTransport>(clock, arm),
                                         driver::make_arm(ArmKind::kPolhem, model)),
      of_device, 0, 100'000'000);
  ASSERT_TRUE(opened) << opened.error().message;
  driver::Device& device = **opened;
  ASSERT_TRUE(device.activate());
  Slope law;
  law.arm = &arm;
  const std::atomic<bool> never{false};
  driver::run_servo(device, clock, driver::ForceLaw(law), driver::TickSink(law),
                    {.period_ns = 1'000'000, .ticks = 500}, never);
  EXPECT_EQ(device.fault(), driver::Fault::kNone);
  const int motors = driver::motor_count(model.geometry);
  const Vector3d sent(law.last.f_sent_W[0], law.last.f_sent_W[1], law.last.f_sent_W[2]);
  const Vector3d given(0, 0.2, motors > 1 ? 0.2 : 0);
  EXPECT_LT((sent - given).norm(), 1e-9);
  EXPECT_LT((device.missing_force().f_W - (Vector3d(0.2, 0.2, 0.2) - given)).norm(), 1e-9);
  EXPECT_GT(device.missing_force().ticks, 490U);
  // Currents in whole mA: the force on the simulated tip is the force that was sent.
  EXPECT_LT((of_device.R_WB * law.f_T_B - given).norm(), 0.01);
}

TEST(ShortArmsSim, DriverGivesThePartAlongTheAxes) {
  expect_projected(five_bar());
  expect_projected(paddle());
  expect_projected(table());
}

TEST(ShortArmsSim, TraitsNameTheAxes) {
  SimulatedArm arm = arm_of(five_bar(), phantom_like(), middle_of(five_bar()));
  driver::VirtualClock clock;
  const driver::WireLink two(std::make_unique<SimTransport>(clock, arm),
                             driver::make_arm(ArmKind::kPolhem, five_bar()));
  EXPECT_EQ(two.traits().axes, 2);
  SimulatedArm other =
      SimulatedArm::make(support::vintage_model(), phantom_like(), resting_at(home_tip())).value();
  const driver::WireLink three(
      std::make_unique<SimTransport>(clock, other),
      driver::make_arm(ArmKind::kPolhem, driver::arm_model(support::vintage_model())));
  EXPECT_EQ(three.traits().axes, 3);
}

}  // namespace
}  // namespace thimble::device_sim
