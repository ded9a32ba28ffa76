#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "board/sim_transport.h"
#include "support/vintage_arm.h"
#include "thimble/driver/clock.h"
#include "thimble/driver/servo_loop.h"
#include "thimble/driver/wire_link.h"

// Every exit ends with the motors off. The tests check the currents of the simulated arm, not the
// driver's state.

namespace thimble {
namespace {

constexpr std::int64_t kPeriod_ns = 1'000'000;

device_sim::SimulatedArmSettings arm_settings() {
  device_sim::SimulatedArmSettings settings;
  settings.plant = {.mass = 0.075, .viscous = 0.005, .coulomb = 0.04};
  settings.hand = {.mass = 0.025, .stiffness = 300, .damping = 3};
  settings.motors.current_max = 6;
  return settings;
}

struct NoForce {
  void operator()(const driver::TickRecord&) const noexcept {}
};

class WaysOut : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto model = support::vintage_model();
    const Eigen::Vector3d home = model.geometry.forward(support::vintage_home());
    arm_ = std::make_unique<device_sim::SimulatedArm>(
        device_sim::SimulatedArm::make(
            model, arm_settings(), device_sim::HandPath::make({{.time = 0, .p_BH = home}}).value())
            .value());
    auto transport = std::make_unique<device_sim::SimTransport>(clock_, *arm_);
    transport_ = transport.get();
    auto opened = driver::Device::open(
        std::make_unique<driver::WireLink>(std::move(transport),
                                           std::make_unique<driver::hfab::HfabArm>(model)),
        support::vintage_settings(), clock_.now_ns());
    ASSERT_TRUE(opened) << opened.error().message;
    device_ = std::move(opened).value();
    ASSERT_TRUE(device_->activate());
  }

  /// Runs a push of 1 N for `ticks`, with `at_tick` called in tick 500.
  template <class AtTick>
  driver::ServoEnd push(std::uint64_t ticks, AtTick at_tick) {
    auto law = [&](const driver::DeviceState& state) noexcept {
      driver::ForceCommand command{.f_T_W = {1, 0, 0}, .touch = {}};
      if (state.tick == 500) {
        current_before_ = current();
        at_tick(command);
      }
      return command;
    };
    NoForce no_force;
    return driver::run_servo(*device_, clock_, driver::ForceLaw(law), driver::TickSink(no_force),
                             {.period_ns = kPeriod_ns, .ticks = ticks}, stop_);
  }

  /// Returns the largest current in the simulated motors, A.
  double current() const { return arm_->firmware().currents().cwiseAbs().maxCoeff(); }

  void let_pass(std::int64_t ns) {
    clock_.sleep_until_ns(clock_.now_ns() + ns);
    arm_->advance_to(clock_.now_ns());
  }

  driver::VirtualClock clock_;
  std::unique_ptr<device_sim::SimulatedArm> arm_;
  std::unique_ptr<driver::Device> device_;
  device_sim::SimTransport* transport_ = nullptr;
  std::atomic<bool> stop_{false};
  double current_before_ = 0;
};

TEST_F(WaysOut, EndOfRunTurnsTheMotorsOffAtOnce) {
  EXPECT_EQ(push(1000, [](auto&) {}), driver::ServoEnd::kDone);
  EXPECT_GT(current_before_, 0.1);
  let_pass(0);
  EXPECT_EQ(current(), 0);
}

TEST_F(WaysOut, TheStopFlagTurnsTheMotorsOffWithinOneTick) {
  EXPECT_EQ(push(0, [this](auto&) { stop_.store(true); }), driver::ServoEnd::kStopped);
  EXPECT_GT(current_before_, 0.1);
  EXPECT_EQ(clock_.now_ns(), 501 * kPeriod_ns);
  let_pass(0);
  EXPECT_EQ(current(), 0);
}

TEST_F(WaysOut, NaNForceTurnsTheMotorsOffInTheSameTick) {
  EXPECT_EQ(push(0, [](driver::ForceCommand& command) { command.f_T_W.y() = NAN; }),
            driver::ServoEnd::kFault);
  EXPECT_GT(current_before_, 0.1);
  EXPECT_EQ(clock_.now_ns(), 500 * kPeriod_ns);
  let_pass(0);
  EXPECT_EQ(current(), 0);
  EXPECT_EQ(device_->fault(), driver::Fault::kForceNotFinite);
}

TEST_F(WaysOut, AnExceptionInTheApplicationTurnsTheMotorsOff) {
  try {
    const std::unique_ptr<driver::Device> owned = std::move(device_);
    for (int k = 0; k < 500; ++k) {
      clock_.sleep_until_ns(clock_.now_ns() + kPeriod_ns);
      owned->read(clock_.now_ns(), clock_.now_ns());
      owned->write({.f_T_W = {1, 0, 0}, .touch = {}});
    }
    let_pass(0);
    EXPECT_GT(current(), 0.1);
    throw std::runtime_error("exception of the application");
  } catch (const std::runtime_error&) {
  }
  let_pass(0);
  EXPECT_EQ(current(), 0);
}

TEST_F(WaysOut, CablePullIsReportedAndMotorsStopIn100ms) {
  EXPECT_EQ(push(0, [this](auto&) { transport_->unplug(); }), driver::ServoEnd::kFault);
  EXPECT_EQ(device_->fault(), driver::Fault::kTransportLost);
  // The last message came in tick 499; the host cannot reach the motors any more.
  EXPECT_GT(current(), 0.1);
  arm_->advance_to((499 + 100) * kPeriod_ns - 1);
  EXPECT_GT(current(), 0.1);
  arm_->advance_to((499 + 100) * kPeriod_ns);
  EXPECT_EQ(current(), 0);
  EXPECT_EQ(arm_->firmware().counters().watchdog_fired, 1u);
}

TEST_F(WaysOut, WatchdogStopsMotorsIfTheHostDies) {
  // From the arm's side, SIGKILL means no more messages, and no final zero.
  push(499, [](auto&) {});
  ASSERT_TRUE(device_->activate());
  for (int k = 0; k < 400; ++k) {
    clock_.sleep_until_ns(clock_.now_ns() + kPeriod_ns);
    device_->read(clock_.now_ns(), clock_.now_ns());
    device_->write({.f_T_W = {1, 0, 0}, .touch = {}});
  }
  let_pass(99 * kPeriod_ns);
  EXPECT_GT(current(), 0.1);
  let_pass(kPeriod_ns);
  EXPECT_EQ(current(), 0);
}

TEST_F(WaysOut, StalledLoopIsAFaultWithoutForce) {
  EXPECT_EQ(push(0, [this](auto&) { clock_.sleep_until_ns(clock_.now_ns() + 150'000'000); }),
            driver::ServoEnd::kFault);
  EXPECT_EQ(device_->fault(), driver::Fault::kLoopStalled);
  let_pass(0);
  EXPECT_EQ(current(), 0);
}

}  // namespace
}  // namespace thimble
