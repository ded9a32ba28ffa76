#include "usb/simulated_falcon.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

#include "arms/falcon/falcon_arm.h"
#include "arms/falcon/falcon_packet.h"
#include "support/refuses.h"
#include "thimble/driver/device.h"
#include "thimble/driver/wire_link.h"

namespace thimble::device_sim::usb {
namespace {

using support::refuses;

/// A driver with a simulated Falcon in the same program, whose hand moves 10 mm to the side in a
/// second.
struct InProgram {
  explicit InProgram(std::vector<std::byte> firmware = {}) {
    SimulatedArmSettings settings;
    settings.plant = {.mass = 0.15, .viscous = 0.005, .coulomb = 0.04};
    settings.hand.stiffness = 300;
    settings.hand.damping = 3;
    const Eigen::Vector3d p_BM = driver::falcon::falcon_geometry().p_BM;
    auto made = SimulatedFalcon::make(driver::falcon::falcon_model(), settings,
                                      HandPath::make({{0, p_BM}, {1, p_BM + p_MH}}).value(),
                                      std::move(firmware));
    EXPECT_TRUE(made) << made.error().message;
    falcon = std::move(made).value();
    driver::DeviceSettings limits;
    limits.limits = {.force_max = 2,
                     .speed_max = 3,
                     .rise_max = 2000,
                     .soft_start = 0.05,
                     .stall_ns = 20'000'000,
                     .watchdog_ns = 100'000'000};
    auto opened = driver::Device::open(
        std::make_unique<driver::WireLink>(
            falcon->wire(clock),
            std::make_unique<driver::falcon::FalconArm>(driver::falcon::falcon_model())),
        limits, 0);
    EXPECT_TRUE(opened) << opened.error().message;
    device = std::move(opened).value();
  }
  void tick(const Eigen::Vector3d& f_T_W) {
    clock.sleep_until_ns(clock.now_ns() + 1'000'000);
    device->read(clock.now_ns(), clock.now_ns());
    device->write({.f_T_W = f_T_W, .touch = {}});
  }

  const Eigen::Vector3d p_MH{0.01, 0, 0};
  std::unique_ptr<SimulatedFalcon> falcon;
  driver::VirtualClock clock;
  std::unique_ptr<driver::Device> device;  // holds the wire to it, so it is destroyed first
};

TEST(SimulatedFalcon, IsHomedBeforeItsHandBegins) {
  InProgram run(std::vector<std::byte>(1500, std::byte{7}));
  EXPECT_TRUE(run.falcon->arm().board().running());
  EXPECT_EQ(run.falcon->arm().board().uploaded(), 1500u);
  const Eigen::Vector3d p_BM = driver::falcon::falcon_geometry().p_BM;
  EXPECT_LT((run.device->state().p_WT - p_BM).norm(), 5e-4);  // dry friction remains
  int fresh = 0;
  for (int k = 0; k < 1200; ++k) {
    run.tick({0, 0, 0});
    fresh += run.device->state().fresh ? 1 : 0;
    // The position is a tick old, at a speed of 1 cm/s, and off by a count or two.
    ASSERT_LT((run.device->state().p_WT - run.falcon->arm().truth().p_BT).norm(), 1.5e-4) << k;
  }
  EXPECT_GE(fresh, 1198);
  EXPECT_LT((run.device->state().p_WT - p_BM - run.p_MH).norm(), 5e-4);
}

TEST(SimulatedFalcon, EveryDriverMessageHasTheHomingBit) {
  InProgram run;
  ASSERT_TRUE(run.device->activate());
  const FalconBoard& board = run.falcon->arm().board();
  std::uint64_t packets = 0;
  const auto look = [&] {
    EXPECT_NE(board.asked().lights & driver::falcon::kHomingMode, 0);
    packets = board.counters().packets;
  };
  for (int k = 0; k < 300; ++k) {
    run.tick({0, k % 2 == 0 ? 0.3 : 0.0, 0});
    EXPECT_LE(board.counters().packets - packets, k == 0 ? board.counters().packets : 1);
    look();
  }
  EXPECT_GT(packets, 250U);
  run.device->trip(driver::Fault::kOverSpeed);
  for (int k = 0; k < 20; ++k) {
    run.tick({0, 0.3, 0});
    look();
  }
  run.device->deactivate();
  for (int k = 0; k < 20; ++k) {
    run.tick({0, 0.3, 0});
    look();
  }
}

/// A Falcon whose answers report, from some time on, that a leg is not homed.
class LegLost final : public driver::Transport {
 public:
  explicit LegLost(std::unique_ptr<driver::Transport> wire) : wire_(std::move(wire)) {}
  driver::TransportRead read_latest(std::span<std::byte> buffer,
                                    std::int64_t deadline_ns) noexcept override {
    const auto read = wire_->read_latest(buffer, deadline_ns);
    if (lost && read.size == driver::falcon::kPacketSize) {
      buffer[13] = static_cast<std::byte>(std::to_integer<unsigned>(buffer[13]) - (1U << 5));
    }
    return read;
  }
  driver::TransportStatus write(std::span<const std::byte> report) noexcept override {
    return wire_->write(report);
  }
  bool lost = false;

 private:
  std::unique_ptr<driver::Transport> wire_;
};

TEST(SimulatedFalcon, GetsNoForceAfterALegLosesHoming) {
  InProgram run;
  run.device.reset();
  auto made = std::make_unique<LegLost>(run.falcon->wire(run.clock));
  LegLost& wire = *made;
  driver::DeviceSettings limits;
  limits.limits = {.force_max = 2,
                   .speed_max = 3,
                   .rise_max = 2000,
                   .soft_start = 0.05,
                   .stall_ns = 20'000'000,
                   .watchdog_ns = 100'000'000};
  auto opened = driver::Device::open(
      std::make_unique<driver::WireLink>(
          std::move(made),
          std::make_unique<driver::falcon::FalconArm>(driver::falcon::falcon_model())),
      limits, run.clock.now_ns());
  ASSERT_TRUE(opened) << opened.error().message;
  run.device = std::move(opened).value();
  ASSERT_TRUE(run.device->activate());
  for (int k = 0; k < 100; ++k) run.tick({0, 0.5, 0});
  ASSERT_GT(run.device->f_sent_W().norm(), 0.4);
  wire.lost = true;
  for (int k = 0; k < 22; ++k) run.tick({0, 0.5, 0});
  EXPECT_EQ(run.device->fault(), driver::Fault::kNoReports);
  EXPECT_EQ(run.device->f_sent_W().norm(), 0);
  EXPECT_GT(run.device->wire_counters().rejected, 19U);
}

TEST(SimulatedFalcon, PushesItsHandBitIdentically) {
  InProgram first, second;
  ASSERT_TRUE(first.device->activate());
  ASSERT_TRUE(second.device->activate());
  for (int k = 0; k < 500; ++k) {
    first.tick({0, 0.6, 0});
    second.tick({0, 0.6, 0});
    ASSERT_EQ(first.device->state().counts, second.device->state().counts) << k;
  }
  EXPECT_NEAR(first.falcon->arm().plant().f_T_B().y(), 0.6, 0.01);
  first.device->deactivate();
  first.falcon->advance_to(first.clock.now_ns() + 2'000'000);
  EXPECT_EQ(first.falcon->arm().truth().currents.norm(), 0);
}

/// Returns the distance (m) along y by which a driver that requests 0.3 N moves the tip of a Falcon
/// in 60 ms.
double pushed(const driver::JointModel<driver::DeltaArm>& model,
              const SimulatedArmSettings& settings) {
  const Eigen::Vector3d p_BM = driver::falcon::falcon_geometry().p_BM;
  auto made = SimulatedFalcon::make(model, settings, HandPath::make({{0, p_BM}}).value(), {});
  EXPECT_TRUE(made) << made.error().message;
  driver::VirtualClock clock;
  driver::DeviceSettings limits;
  limits.limits = {.force_max = 2,
                   .speed_max = 3,
                   .rise_max = 20000,
                   .soft_start = 0.05,
                   .stall_ns = 20'000'000,
                   .watchdog_ns = 100'000'000};
  auto device = driver::Device::open(
      std::make_unique<driver::WireLink>(
          (*made)->wire(clock),
          std::make_unique<driver::falcon::FalconArm>(driver::falcon::falcon_model())),
      limits, 0);
  EXPECT_TRUE(device) << device.error().message;
  EXPECT_TRUE((*device)->activate());
  double begin = 0;
  for (int k = 0; k < 160; ++k) {
    clock.sleep_until_ns(clock.now_ns() + 1'000'000);
    (*device)->read(clock.now_ns(), clock.now_ns());
    (*device)->write({.f_T_W = {0, k < 100 ? 0 : 0.3, 0}, .touch = {}});
    if (k == 100) begin = (*made)->arm().plant().p_BT().y();
  }
  return (*made)->arm().plant().p_BT().y() - begin;
}

TEST(SimulatedFalcon, UsesItsOwnMotorConstants) {
  SimulatedArmSettings settings;
  settings.plant.mass = 0.15;
  auto weak = driver::falcon::falcon_model();
  for (driver::MotorDrive& drive : weak.drives) drive.torque_constant *= 0.5;
  const double whole = pushed(driver::falcon::falcon_model(), settings);
  // No hand holds it, although a hand has homed it: 0.3 N for about 57 ms.
  EXPECT_NEAR(whole, 0.5 * 0.3 / 0.15 * 0.0575 * 0.0575, 2e-4);
  EXPECT_NEAR(pushed(weak, settings) / whole, 0.5, 0.01);
  settings.weight_B = {0, -0.15, 0};
  settings.plant.coulomb = 0.2;  // so that it rests until it is pushed
  const double dry = pushed(driver::falcon::falcon_model(), settings);
  EXPECT_EQ(dry, 0) << "0.3 N less 0.15 N of weight do not overcome 0.2 N of friction";
  settings.weight_B = {0, 0.15, 0};
  EXPECT_NEAR(pushed(driver::falcon::falcon_model(), settings), 0.5 * 0.25 / 0.15 * 0.0575 * 0.0575,
              2e-4);
}

TEST(SimulatedFalcon, MustBeginWithinReach) {
  SimulatedArmSettings settings;
  settings.plant.mass = 0.1;
  const auto falcon = SimulatedFalcon::make(driver::falcon::falcon_model(), settings,
                                            HandPath::make({{0, {1, 0, 0}}}).value(), {});
  EXPECT_TRUE(refuses(falcon, "starting point"));
  settings.firmware.wiring.encoder_of = {0, 1, 7};
  const auto miswired = SimulatedFalcon::make(
      driver::falcon::falcon_model(), settings,
      HandPath::make({{0, driver::falcon::falcon_geometry().p_BM}}).value(), {});
  EXPECT_TRUE(refuses(miswired, "wiring"));
}

}  // namespace
}  // namespace thimble::device_sim::usb
