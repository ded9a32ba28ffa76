// The complete chain of an arm on USB in simulated time: hand, mechanics, board, USB/IP, driver,
// force. tests/usb does the same through a real kernel.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

#include "arms/falcon/falcon_boot.h"
#include "arms/falcon/falcon_packet.h"
#include "support/boards/deaf_board.h"
#include "support/boards/shelf_entry.h"
#include "support/boards/usb_host_line.h"
#include "support/boards/usb_host_transport.h"
#include "support/long_form.h"
#include "thimble/driver/device.h"
#include "thimble/driver/wire_link.h"
#include "usb/virtual_arm.h"

namespace thimble {
namespace {

namespace usb = device_sim::usb;

constexpr std::int64_t kTick_ns = 1'000'000;

class UsbTouch : public testing::TestWithParam<usb::ShelfEntry> {
 protected:
  void SetUp() override {
    virtual_arm_.name = GetParam().name;
    wall_.emplace(virtual_arm_.wall());
    auto arm = usb::make_usb_arm(virtual_arm_.name, {});
    ASSERT_TRUE(arm.ok());
    arm_ = std::move(*arm);
    faulty_.emplace(*arm_, 3);
    server_.emplace(*faulty_, "1-1");
    plug();
    auto transport = wire();  // brings the clock to the bus's time
    auto device = driver::Device::open(
        std::make_unique<driver::WireLink>(std::move(transport), virtual_arm_.protocol()),
        usb_test::check_settings(), clock_.now_ns());
    ASSERT_TRUE(device.ok()) << device.error().message;
    device_ = std::move(*device);
    ASSERT_TRUE(device_->activate().ok());
  }
  void TearDown() override {
    device_.reset();
    host_.reset();
    server_.reset();
  }

  void plug() {
    host_.emplace(*server_);
    ASSERT_TRUE(host_->import_device());
    host_->configure();
    if (!virtual_arm_.is_falcon()) return;
    support::UsbHostLine line(*host_);
    const driver::falcon::BootSettings quick{.settle_ms = 0};
    const std::vector<std::byte> image(500, std::byte{0x5a});
    ASSERT_TRUE(driver::falcon::upload_firmware(line, image, quick).ok());
    driver::falcon::HomingState state;
    for (int i = 0; i < 3000 && !state.done(); ++i) {
      state = driver::falcon::home_once(line, state.homed, quick);
    }
    ASSERT_TRUE(state.done());
  }
  std::unique_ptr<driver::Transport> wire() {
    if (virtual_arm_.is_falcon()) {
      return std::make_unique<support::UsbHostTransport>(*host_, clock_, 64,
                                                         driver::falcon::kPacketFraming);
    }
    const std::size_t size = virtual_arm_.name == "woodenhaptics" ? 8
                             : virtual_arm_.name == "polhem"      ? 14
                                                                  : 64;
    const bool teensy = virtual_arm_.name == "polhem-64";
    return std::make_unique<support::UsbHostTransport>(*host_, clock_, size, std::nullopt,
                                                       teensy ? 3 : 1, teensy ? 4 : 1);
  }

  void tick() {
    clock_.sleep_until_ns(clock_.now_ns() + kTick_ns);
    const std::int64_t now_ns = clock_.now_ns();
    const driver::DeviceState& state = device_->read(now_ns, now_ns);
    device_->write((*wall_)(state));
    force_ = device_->f_sent_W().norm();
    force_max_ = std::max(force_max_, force_);
  }
  bool touch_until_contact() {
    for (int i = 0; i < 3000; ++i) {
      tick();
      if (force_ > 0.5) return true;
    }
    return false;
  }
  /// Returns the expected request to the motors: tau = J^T f of this tick, in the wire's unit.
  Eigen::Vector3d motor_values() const {
    const auto protocol = virtual_arm_.protocol();
    driver::ArmReading reading;
    reading.counts = device_->state().counts;
    const Eigen::Vector3d tau = protocol->pose(reading).J_BT.transpose() * device_->f_sent_W();
    Eigen::Vector3d values;
    for (int i = 0; i < 3; ++i) {
      const driver::MotorDrive& drive = protocol->drives()[static_cast<std::size_t>(i)];
      values[i] = 1000 * tau[i] / (drive.sign * drive.ratio * drive.torque_constant);
    }
    return values;
  }

  usb_test::VirtualArm virtual_arm_;
  std::unique_ptr<usb::UsbArm> arm_;
  std::optional<usb::FaultyDevice> faulty_;
  std::optional<usb::UsbipServer> server_;
  std::optional<support::UsbHost> host_;
  driver::VirtualClock clock_;
  std::unique_ptr<driver::Device> device_;
  std::optional<usb_test::Wall> wall_;
  double force_ = 0, force_max_ = 0;
};

TEST_P(UsbTouch, TransfersPositionAndForceWithinAQuantum) {
  const int ticks = support::long_form() ? 10'000 : 3'000;
  int in_contact = 0, fresh = 0;
  Eigen::Vector3d wanted(0, 0, 0);
  std::int64_t sampled_ns = 0;
  bool was_fresh = false;
  for (int i = 0; i < ticks; ++i) {
    tick();
    const usb::ArmTruth truth = arm_->truth();
    if (i > 0) {
      // The message of the previous tick has arrived in this frame.
      for (int k = 0; k < 3; ++k) {
        ASSERT_LE(std::abs(truth.motor_values[static_cast<std::size_t>(k)] - wanted[k]), 0.5001);
      }
      // Encoders were sampled, read and answered, and the motors changed at most two frames later.
      if (was_fresh) {
        ASSERT_LE(truth.message_ns - sampled_ns, 2 * kTick_ns) << i;
      }
    }
    wanted = motor_values();
    if (device_->state().fresh) {
      ++fresh;
      ASSERT_EQ(device_->state().counts, truth.counts);
      for (int k = 0; k < 3; ++k) {
        const auto count = truth.counts[static_cast<std::size_t>(k)];
        ASSERT_LE(std::abs(count - truth.exact_counts[k]), 0.5);
      }
    }
    sampled_ns = truth.report_ns;
    was_fresh = device_->state().fresh;
    in_contact += force_ > 0 ? 1 : 0;
  }
  EXPECT_EQ(device_->fault(), driver::Fault::kNone);
  EXPECT_GT(in_contact, ticks / 10);
  EXPECT_GE(fresh, ticks - 3);
}

TEST_P(UsbTouch, KeepsTheForceWithinItsLimitUnderEveryFault) {
  std::vector<usb::FaultKind> kinds;
  for (std::size_t kind = 0; kind < usb::kFaultKinds; ++kind) {
    kinds.push_back(static_cast<usb::FaultKind>(kind));
  }
  std::erase(kinds, usb::FaultKind::kUnplug);
  // Flipped bits in messages to the arm may set the counters of a board, or permanently unhome a
  // Falcon.
  std::erase(kinds, usb::FaultKind::kBitErrors);
  kinds.push_back(usb::FaultKind::kBitErrors);
  for (const usb::FaultKind fault : kinds) {
    for (const char* way : {" in", " out"}) {
      const std::string line = std::string(usb::name(fault)) + way + " for=100 rate=0.01";
      SCOPED_TRACE(line);
      ASSERT_TRUE(touch_until_contact());
      faulty_->order(*usb::parse_fault(line));
      // A converter passes additional bytes, which are no message and are skipped.
      const bool babbles = fault == usb::FaultKind::kLong && !virtual_arm_.is_falcon();
      const bool stops =
          std::string_view(way) == " in"
              ? fault == usb::FaultKind::kStall || fault == usb::FaultKind::kShort || babbles ||
                    fault == usb::FaultKind::kSilence || fault == usb::FaultKind::kLost ||
                    // Its reports have numbers, so an old report is detected.
                    (fault == usb::FaultKind::kStale && virtual_arm_.name == "woodenhaptics")
              // An arm that sends only when asked is silent when messages to it are lost.
              : fault == usb::FaultKind::kLost && virtual_arm_.answers();
      const bool deaf = support::is_deaf(!virtual_arm_.is_falcon(), virtual_arm_.answers(),
                                         std::string(usb::name(fault)) + way);
      for (int i = 0; i < 150; ++i) {
        tick();
        ASSERT_TRUE(std::isfinite(force_));
        ASSERT_LE(force_, usb_test::check_settings().limits.force_max + 1e-9);
        // 20 ms of silence and the tick that detects it.
        if (stops && i > 22 && i < 100) {
          ASSERT_TRUE(force_ == 0 || (deaf && !device_->zero_assured())) << i << " " << force_;
        }
      }
      if (stops) {
        EXPECT_EQ(device_->fault(), driver::Fault::kNoReports);
      }
      faulty_->heal();
      for (int i = 0; i < 10; ++i) tick();
      ASSERT_TRUE(device_->activate(driver::HomeCheck::kPassed).ok());  // no board restarted
    }
  }
}

TEST_P(UsbTouch, CablePullEndsSendingAndSwitchesTheArmOff) {
  ASSERT_TRUE(touch_until_contact());
  ASSERT_GT(arm_->truth().currents.norm(), 0);
  faulty_->order(*usb::parse_fault("unplug"));
  for (int i = 0; i < 2; ++i) tick();
  EXPECT_EQ(device_->fault(), driver::Fault::kTransportLost);
  EXPECT_EQ(force_, 0);
  for (int i = 0; i < 500; ++i) host_->frames();
  EXPECT_FALSE(arm_->truth().motors_on);
  EXPECT_EQ(arm_->truth().currents.norm(), 0);
}

INSTANTIATE_TEST_SUITE_P(Arms, UsbTouch, testing::ValuesIn(usb::kShelf),
                         [](const auto& param_info) {
                           std::string name(param_info.param.name);
                           std::erase(name, '-');
                           return name;
                         });

}  // namespace
}  // namespace thimble
