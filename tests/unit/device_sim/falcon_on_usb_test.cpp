#include "usb/falcon_on_usb.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include <random>

#include "arms/falcon/falcon_arm.h"
#include "arms/falcon/falcon_boot.h"
#include "support/boards/usb_host_line.h"
#include "support/seed.h"
#include "thimble/device_sim/usb/arm_shelf.h"

namespace thimble::device_sim::usb {
namespace {

std::vector<std::byte> some_image(std::size_t size) {
  std::mt19937_64 random(5);
  std::vector<std::byte> image(size);
  for (std::byte& byte : image) byte = static_cast<std::byte>(random());
  return image;
}

class FalconOnUsbTest : public testing::Test {
 protected:
  void plug(const ShelfOptions& options) {
    auto arm = make_usb_arm("falcon", options);
    ASSERT_TRUE(arm.ok());
    arm_ = std::move(*arm);
    falcon_ = dynamic_cast<const FalconOnUsb*>(arm_.get());
    ASSERT_NE(falcon_, nullptr);
    faulty_.emplace(*arm_);
    server_.emplace(*faulty_, "1-1");
    host_.emplace(*server_);
    ASSERT_TRUE(host_->import_device());
    host_->configure();
    line_.emplace(*host_);
  }
  void TearDown() override {
    line_.reset();
    host_.reset();
    server_.reset();
  }
  ShelfOptions with_image() const {
    ShelfOptions options;
    options.firmware = image_;
    return options;
  }

  std::unique_ptr<UsbArm> arm_;
  const FalconOnUsb* falcon_ = nullptr;
  std::optional<FaultyDevice> faulty_;
  std::optional<UsbipServer> server_;
  std::optional<support::UsbHost> host_;
  std::optional<support::UsbHostLine> line_;
  std::vector<std::byte> image_ = some_image(2000);
  driver::falcon::BootSettings quick_{.greetings_max = 5, .settle_ms = 0};
};

TEST_F(FalconOnUsbTest, SendsNothingBeforeItHasFirmware) {
  plug({});
  ASSERT_TRUE(driver::falcon::enter_run_mode(*line_).ok());
  EXPECT_FALSE(driver::falcon::firmware_answers(*line_, quick_));
  EXPECT_FALSE(falcon_->board().running());
}

TEST_F(FalconOnUsbTest, BootsTakesFirmwareAndRunsIt) {
  plug(with_image());
  const auto report = driver::falcon::upload_firmware(*line_, image_, quick_);
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_EQ(report->attempts, 1);
  EXPECT_TRUE(falcon_->board().running());
  EXPECT_EQ(falcon_->board().uploaded(), image_.size());
  EXPECT_EQ(falcon_->chip().latency_ms(), 1);
  EXPECT_TRUE(driver::falcon::firmware_answers(*line_, quick_));
}

TEST_F(FalconOnUsbTest, DoesNotRunCorruptFirmware) {
  plug(with_image());
  ASSERT_TRUE(driver::falcon::enter_boot_loader(*line_, quick_).ok());
  std::vector<std::byte> wrong(image_.begin(), image_.begin() + 62);
  wrong[30] ^= std::byte{1};
  ASSERT_TRUE(line_->write(wrong));
  host_->frames(50);
  ASSERT_TRUE(driver::falcon::enter_run_mode(*line_).ok());
  host_->frames(5);
  EXPECT_FALSE(falcon_->board().running());
}

TEST_F(FalconOnUsbTest, UploadSucceedsOverABadCable) {
  plug(with_image());
  // One bit in 20,000 flips in each direction, about one in the 16,000 bits of the first upload,
  // until the cable is plugged in properly after 400 frames.
  faulty_->order(*parse_fault("bit_errors out rate=0.00005 for=400"));
  faulty_->order(*parse_fault("bit_errors in rate=0.00005 for=400"));
  quick_.block_attempts_max = 20;
  const auto report = driver::falcon::upload_firmware(*line_, image_, quick_);
  ASSERT_TRUE(report.ok()) << report.error().message;
  EXPECT_TRUE(falcon_->board().running());
}

TEST_F(FalconOnUsbTest, PositionIsKnownOnlyAfterHoming) {
  plug({});
  ASSERT_TRUE(driver::falcon::upload_firmware(*line_, image_, quick_).ok());
  auto state = driver::falcon::home_once(*line_, 0, quick_);
  ASSERT_TRUE(state.answered);
  EXPECT_FALSE(state.done());
  EXPECT_GT(std::abs(state.counts[0] - falcon_->plant().exact_counts()[0]), 100);
  for (int i = 0; i < 3000 && !state.done(); ++i) {
    state = driver::falcon::home_once(*line_, state.homed, quick_);
  }
  ASSERT_TRUE(state.done());
  for (int i = 0; i < 100; ++i) {
    driver::falcon::home_once(*line_, state.homed, quick_);
    const ArmTruth truth = falcon_->truth();
    for (int leg = 0; leg < 3; ++leg) {
      const auto count = truth.counts[static_cast<std::size_t>(leg)];
      EXPECT_LE(std::abs(count - truth.exact_counts[leg]), 0.5);
    }
  }
}

TEST_F(FalconOnUsbTest, HandHomesTheArmAtAnyTime) {
  const Eigen::Vector3d p_BM = driver::falcon::falcon_geometry().p_BM;
  for (const HandMotion motion : {HandMotion::kRest, HandMotion::kTap, HandMotion::kStroke}) {
    for (const int late_ms : {0, 1300}) {  // the driver may start while the hand is moving
      SCOPED_TRACE(std::to_string(static_cast<int>(motion)) + ", " + std::to_string(late_ms));
      ShelfOptions options;
      options.motion = motion;
      TearDown();
      line_.reset();
      plug(options);
      host_->frames(late_ms);
      ASSERT_TRUE(driver::falcon::upload_firmware(*line_, image_, quick_).ok());
      const Eigen::Vector3d before = falcon_->plant().p_BT();
      driver::falcon::HomingState state;
      const std::int64_t begin = host_->frame();
      while (!state.done() && host_->frame() - begin < 2500) {
        state = driver::falcon::home_once(*line_, state.homed, quick_);
      }
      ASSERT_TRUE(state.done());
      EXPECT_LT((falcon_->plant().p_BT() - p_BM).norm(), 0.045);
      // The hand returns to its position and continues its path from there.
      host_->frames(600);
      if (motion == HandMotion::kRest) {
        EXPECT_LT((falcon_->plant().p_BT() - p_BM).norm(), 5e-4);
        host_->frames(2000);
        EXPECT_LT((falcon_->plant().p_BT() - p_BM).norm(), 5e-4) << "it homes once";
      } else {
        host_->frames(1000);
        EXPECT_GT((falcon_->plant().p_BT() - before).norm(), 5e-4);
      }
      driver::falcon::home_once(*line_, state.homed, quick_);
      const ArmTruth truth = falcon_->truth();
      for (int leg = 0; leg < 3; ++leg) {
        const auto count = truth.counts[static_cast<std::size_t>(leg)];
        EXPECT_LE(std::abs(count - truth.exact_counts[leg]), 0.5);
      }
    }
  }
}

TEST_F(FalconOnUsbTest, OnePacketWithoutTheHomingBitLosesHoming) {
  ShelfOptions options;
  options.motion = HandMotion::kRest;
  plug(options);
  ASSERT_TRUE(driver::falcon::upload_firmware(*line_, image_, quick_).ok());
  driver::falcon::HomingState state;
  for (int i = 0; i < 3000 && !state.done(); ++i) {
    state = driver::falcon::home_once(*line_, state.homed, quick_);
  }
  ASSERT_TRUE(state.done());
  driver::falcon::HostPacket packet;
  packet.lights = driver::falcon::kGreenLight;
  ASSERT_TRUE(line_->write(driver::falcon::encode_host_packet(packet)));
  host_->frames(3);
  EXPECT_EQ(falcon_->board().answered().homed, 0);
  state = driver::falcon::home_once(*line_, driver::falcon::kAllHomed, quick_);
  ASSERT_TRUE(state.answered);
  EXPECT_FALSE(state.done()) << "the bit does not restore homing";
}

/// A homed board that runs some firmware, and its answer to one packet.
struct HomedBoard {
  explicit HomedBoard(FalconHoming homing) : board({}, homing) {
    for (const bool dtr : {false, true}) board.wires(dtr, false);
    for (const char letter : {'\x0a', '\x43', '\x0d', 'A', 'x'}) hear(letter);
    board.host_rate(1'500'000);
    board.set_encoders({5, 5, 5});
    say(driver::falcon::kHomingMode);
    board.set_encoders({-5, -5, -5});
  }
  void hear(char letter) { board.hear(static_cast<std::byte>(letter), says); }
  driver::falcon::ArmPacket say(std::uint8_t lights) {
    driver::falcon::HostPacket packet;
    packet.lights = lights;
    for (const std::byte byte : driver::falcon::encode_host_packet(packet)) board.hear(byte, says);
    return board.answered();
  }
  FalconBoard board;
  ByteQueue says;
};

TEST(FalconBoard, DecodesAPacketWithoutTheHomingBit) {
  using driver::falcon::kAllHomed;
  using driver::falcon::kHomingMode;
  for (const FalconHoming homing :
       {FalconHoming::kForgets, FalconHoming::kHidesFlags, FalconHoming::kKeeps}) {
    HomedBoard homed(homing);
    ASSERT_TRUE(homed.board.running());
    ASSERT_EQ(homed.say(kHomingMode).homed, kAllHomed);
    ASSERT_EQ(homed.say(kHomingMode).counts[0], -5);
    const auto without = homed.say(0);
    EXPECT_EQ(without.homed, homing == FalconHoming::kKeeps ? kAllHomed : 0);
    EXPECT_EQ(without.counts[0] == -5, homing != FalconHoming::kForgets);
    const auto with = homed.say(kHomingMode);
    EXPECT_EQ(with.homed, homing == FalconHoming::kForgets ? 0 : kAllHomed);
    EXPECT_EQ(with.counts[0] == -5, homing != FalconHoming::kForgets);
  }
}

TEST_F(FalconOnUsbTest, LosesItsFirmwareWhenDtrRises) {
  plug({});
  ASSERT_TRUE(driver::falcon::upload_firmware(*line_, image_, quick_).ok());
  ASSERT_TRUE(line_->set_dtr(false));
  ASSERT_TRUE(line_->set_dtr(true));
  EXPECT_FALSE(falcon_->board().running());
}

TEST_F(FalconOnUsbTest, ReceivesNothingAtTheWrongBaudRate) {
  plug({});
  ASSERT_TRUE(line_->set_rate_divisor(driver::falcon::kRunDivisor));
  ASSERT_TRUE(line_->write(image_));
  host_->frames(20);
  EXPECT_EQ(falcon_->chip().garbled(), image_.size());
}

TEST_F(FalconOnUsbTest, LatencyTimerSendsStatusOnly) {
  plug({});
  ASSERT_TRUE(line_->set_latency_ms(16));
  std::vector<std::int64_t> frames;
  for (int packet = 0; packet < 4; ++packet) {
    const std::uint32_t asked = host_->ask(1, 64);
    for (;;) {
      host_->frames();
      const auto done = host_->done(asked);
      if (!done) continue;
      EXPECT_EQ(done->data.size(), FtdiChip::kStatusBytes);
      frames.push_back(done->frame);
      break;
    }
  }
  EXPECT_EQ(frames[3] - frames[2], 16);
}

TEST_F(FalconOnUsbTest, SwitchesTheMotorsOffWhenTheHostIsSilent) {
  plug({});
  ASSERT_TRUE(driver::falcon::upload_firmware(*line_, image_, quick_).ok());
  driver::falcon::HostPacket packet;
  packet.motors = {500, 500, 500};
  ASSERT_TRUE(line_->write(driver::falcon::encode_host_packet(packet)));
  host_->frames(2);
  EXPECT_GT(falcon_->truth().currents.norm(), 0.1);
  host_->frames(98);
  EXPECT_TRUE(falcon_->truth().motors_on);
  host_->frames(4);
  EXPECT_EQ(falcon_->truth().currents.norm(), 0);
}

TEST(DeltaPlant, TorquesExertTheExpectedTipForce) {
  // Checked against the driver's Jacobian, which is computed differently: f = J^-T tau.
  const auto model = driver::falcon::falcon_model();
  std::mt19937_64 random(support::seed_of(11));
  std::uniform_real_distribution<double> in_ball(-0.03, 0.03), amperes(-2, 2);
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d p_BT =
        model.geometry.p_BM + Eigen::Vector3d(in_ball(random), in_ball(random), in_ball(random));
    DeltaPlant plant =
        DeltaPlant::make(model, {.mass = 0.1}, {}, {.current_max = 5}, p_BT, p_BT).value();
    const Eigen::Vector3d currents(amperes(random), amperes(random), amperes(random));
    plant.set_currents(currents);
    Eigen::Vector3d tau, p;
    Eigen::Matrix3d J;
    for (int leg = 0; leg < 3; ++leg) {
      const auto& drive = model.drives[static_cast<std::size_t>(leg)];
      tau[leg] = drive.sign * drive.ratio * drive.torque_constant * currents[leg];
    }
    model.geometry.forward(plant.q(), p, J);
    EXPECT_LT((p - p_BT).norm(), 1e-9);
    const Eigen::Vector3d expected = J.transpose().inverse() * tau;
    EXPECT_LT((plant.f_T_B() - expected).norm(), 1e-6 * expected.norm());
  }
}

TEST(DeltaPlant, FollowsTheHandAndYieldsToTheMotors) {
  const auto model = driver::falcon::falcon_model();
  DeltaPlant plant = DeltaPlant::make(model, {.mass = 0.1}, {.stiffness = 300, .damping = 10},
                                      {.current_max = 5}, model.geometry.p_BM, model.geometry.p_BM)
                         .value();
  plant.set_currents({0.2, 0.2, 0.2});
  for (int i = 0; i < 2000; ++i) plant.step(model.geometry.p_BM, 1'000'000);
  // At rest, the spring of the hand balances the motors.
  const Eigen::Vector3d away = plant.p_BT() - model.geometry.p_BM;
  EXPECT_GT(away.norm(), 1e-3);
  EXPECT_LT((300 * away - plant.f_T_B()).norm(), 1e-6);
}

TEST(DeltaPlant, StopsAtTheEndOfReach) {
  const auto model = driver::falcon::falcon_model();
  DeltaPlant plant = DeltaPlant::make(model, {.mass = 0.1}, {.stiffness = 300, .damping = 3},
                                      {.current_max = 5}, model.geometry.p_BM, model.geometry.p_BM)
                         .value();
  const Eigen::Vector3d far = model.geometry.p_BM + Eigen::Vector3d(0, 0, 1);
  for (int i = 0; i < 3000; ++i) plant.step(far, 1'000'000);
  EXPECT_TRUE(plant.p_BT().allFinite());
  EXPECT_TRUE(model.geometry.inverse(plant.p_BT()).has_value());
}

}  // namespace
}  // namespace thimble::device_sim::usb
