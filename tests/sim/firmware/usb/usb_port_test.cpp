// The USB drivers of boards over models of their controllers, with a scripted host. The firmware
// above them is that of the boards.
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <optional>
#include <random>

#include "../host_wire.h"
#include "firmware/boards/hid_link.h"
#include "firmware/core/run_loop.h"
#include "usb_board.h"
#include "usb_host.h"

namespace thimble::firmware_test {
namespace {

struct ChipCase {
  const char* name;
  std::unique_ptr<UsbChip> (*make)();
  bool offers_high_speed, high_speed;
};

// Passes of the loop take 10 us here.
constexpr std::uint32_t kPass_us = 10;

class FirmwareUsbPort : public testing::TestWithParam<ChipCase> {
 protected:
  void SetUp() override {
    usb_board = {};
    usb_board.chip = chip_.get();
    usb_board.inputs.supply_mV = 24'000;
    usb_board.inputs.counts[0] = -5;
    firmware::hid_link::start({"tested", {1, 2, 3, 4, 5, 6, 7, 8}, 1000, 1000});
    loop_.emplace();
    run(100);
  }
  void TearDown() override {
    for (const std::string& text : chip_->model().misuses()) ADD_FAILURE() << text;
    for (const std::string& text : host_.violations()) ADD_FAILURE() << text;
  }

  void run(std::uint32_t time_us) {
    for (std::uint32_t past = 0; past < time_us; past += kPass_us) {
      loop_->pass();
      usb_board.now_us += kPass_us;
    }
  }
  bool motors_on() const { return usb_board.outputs.motors_on; }

  static Bytes message(std::uint8_t type, std::optional<float> amperes = {}) {
    Bytes bytes{type, 1, 0, 0};
    if (amperes) {
      bytes.resize(16);
      const auto bits = std::bit_cast<std::uint32_t>(*amperes);
      for (unsigned i = 0; i < 4; ++i) bytes[4 + i] = static_cast<std::uint8_t>(bits >> 8 * i);
    }
    const std::uint16_t crc = HostWire::crc(std::as_bytes(std::span(bytes)));
    bytes.push_back(static_cast<std::uint8_t>(crc));
    bytes.push_back(static_cast<std::uint8_t>(crc >> 8));
    return bytes;
  }
  static std::uint32_t field(const Bytes& bytes, std::size_t at, std::size_t size) {
    return HostWire::field(std::as_bytes(std::span(bytes)), at, size);
  }
  static bool is_state(const Bytes& bytes) {
    driver::ArmReading reading;
    return HostWire::decode(std::as_bytes(std::span(bytes)), reading);
  }
  /// Fetches reports until one is of now; returns it.
  Bytes new_report() {
    run(1000);
    host_.report();
    run(1000);
    Bytes report = host_.report().value_or(Bytes());
    report.resize(64);
    return report;
  }
  /// Sends a message and lets the board take it.
  void send(const Bytes& bytes) {
    EXPECT_EQ(host_.send(bytes), Handshake::kAck);
    run(50);
  }
  void start_driving() {
    ASSERT_TRUE(host_.enumerate());
    send(message(0x12));
    run(1000);
    send(message(0x10, 0.0f));
    send(message(0x10, 0.5f));
    ASSERT_TRUE(motors_on());
  }

  std::unique_ptr<UsbChip> chip_ = GetParam().make();
  std::optional<firmware::RunLoop> loop_;
  UsbHost host_{chip_->model(), [this] { run(20); }};
};

TEST_P(FirmwareUsbPort, EnumeratesAndNamesTheArm) {
  ASSERT_TRUE(host_.enumerate());
  EXPECT_EQ(host_.text(1), "thimble");
  EXPECT_EQ(host_.text(2), "Thimble arm: reference");
  EXPECT_EQ(host_.text(3), "0102030405060708");
}

TEST_P(FirmwareUsbPort, SelfDescriptionIsTheFeatureReport) {
  ASSERT_TRUE(host_.enumerate());
  const auto bytes = host_.read(0xa1, 1, 0x0300, 64);
  ASSERT_TRUE(bytes);
  ASSERT_EQ(bytes->size(), 64u);
  EXPECT_EQ(field(*bytes, 0, 3), 0x030102u);
  EXPECT_EQ(std::memcmp(bytes->data() + 4, "\1\2\3\4\5\6\7\10", 8), 0);
  EXPECT_EQ(std::memcmp(bytes->data() + 56, "tested", 6), 0);
  EXPECT_EQ(HostWire::crc(std::as_bytes(std::span(*bytes).first(62))), field(*bytes, 62, 2));
}

TEST_P(FirmwareUsbPort, FullLastPacketIsFollowedByAnEmptyOne) {
  ASSERT_TRUE(host_.enumerate());
  const auto bytes = host_.read(0xa1, 1, 0x0300, 100);
  ASSERT_TRUE(bytes);
  EXPECT_EQ(bytes->size(), 64u);
}

TEST_P(FirmwareUsbPort, SendsAReportPerMillisecond) {
  ASSERT_TRUE(host_.enumerate());
  Bytes last = new_report();
  for (int i = 0; i < 1000; ++i) {
    run(1000);
    const auto report = host_.report();
    ASSERT_TRUE(report);
    ASSERT_EQ(report->size(), 64u);
    ASSERT_TRUE(is_state(*report));
    ASSERT_EQ(field(*report, 2, 2), (field(last, 2, 2) + 1) & 0xffff);
    ASSERT_EQ(field(*report, 4, 4) - field(last, 4, 4), 1000u);
    last = *report;
  }
  EXPECT_EQ(field(last, 8, 4), 0xfffffffbu);
}

TEST_P(FirmwareUsbPort, HasNoReportBetweenTwoTicks) {
  ASSERT_TRUE(host_.enumerate());
  run(1000);
  EXPECT_TRUE(host_.report());
  EXPECT_FALSE(host_.report());
}

TEST_P(FirmwareUsbPort, ReportThatWaitedIsWhole) {
  ASSERT_TRUE(host_.enumerate());
  for (int i = 0; i < 20; ++i) {
    run(7300);
    const auto report = host_.report();
    ASSERT_TRUE(report);
    EXPECT_TRUE(is_state(*report));
  }
}

TEST_P(FirmwareUsbPort, CommandReachesTheMotors) {
  start_driving();
  EXPECT_EQ(usb_board.outputs.amperes[0], 0.5f);
  for (int i = 0; i < 100; ++i) {
    send(message(0x10, 0.01f * static_cast<float>(i)));
    ASSERT_EQ(usb_board.outputs.amperes[0], 0.01f * static_cast<float>(i));
  }
}

TEST_P(FirmwareUsbPort, ShortMessageIsNotCompletedByAnOldOne) {
  start_driving();
  const Bytes bytes = message(0x10, 0.25f);
  send(bytes);
  const std::uint32_t refused = field(new_report(), 42, 2);
  Bytes begin(bytes.begin(), bytes.begin() + 8);
  EXPECT_EQ(chip_->model().out(17, 1, host_.toggle_out(), begin), Handshake::kAck);
  run(50);
  EXPECT_EQ(field(new_report(), 42, 2), refused + 1);
}

TEST_P(FirmwareUsbPort, MessageIsTakenOnce) {
  ASSERT_TRUE(host_.enumerate());
  const std::uint32_t refused = field(new_report(), 42, 2);
  send(Bytes(64, 0x10));
  EXPECT_EQ(field(new_report(), 42, 2), refused + 1);
}

TEST_P(FirmwareUsbPort, MessageWaitsUntilTheLastOneIsTaken) {
  ASSERT_TRUE(host_.enumerate());
  EXPECT_EQ(host_.send(message(0x12)), Handshake::kAck);
  EXPECT_EQ(host_.send(message(0x12)), Handshake::kNak);
  run(50);
  EXPECT_EQ(host_.send(message(0x12)), Handshake::kAck);
}

TEST_P(FirmwareUsbPort, UnknownRequestIsStalled) {
  ASSERT_TRUE(host_.enumerate());
  EXPECT_FALSE(host_.command(0x40, 0x77, 0));
  EXPECT_FALSE(host_.read(0xc0, 0x77, 0, 64));
  EXPECT_FALSE(host_.descriptor(3, 9));
  EXPECT_FALSE(host_.read(0xa1, 1, 0x0100, 64));
  EXPECT_EQ(host_.text(2), "Thimble arm: reference") << "after the stalls";
}

TEST_P(FirmwareUsbPort, AbandonedRequestDoesNotSpoilTheNext) {
  ASSERT_TRUE(host_.enumerate());
  for (int i = 0; i < 5; ++i) {
    host_.begin(0x80, 6, 0x0302, 255);
    EXPECT_EQ(host_.text(3), "0102030405060708");
  }
}

TEST_P(FirmwareUsbPort, PacketOfAnAbandonedAnswerIsNotCounted) {
  ASSERT_TRUE(host_.enumerate());
  host_.begin(0xa1, 1, 0x0300, 100);
  InPacket packet = chip_->model().in(17, 0);
  for (int i = 0; i < 10 && packet.answer == Handshake::kNak; ++i) {
    run(kPass_us);
    packet = chip_->model().in(17, 0);
  }
  EXPECT_EQ(packet.bytes.size(), 64u);
  // The next request arrives before the driver has seen that the packet was fetched.
  EXPECT_EQ(host_.read(0xa1, 1, 0x0300, 100).value_or(Bytes()).size(), 64u);
}

TEST_P(FirmwareUsbPort, OnlyTheLastOfTwoRequestsIsAnswered) {
  ASSERT_TRUE(host_.enumerate());
  chip_->model().setup(17, {0x80, 6, 2, 3, 0, 0, 255, 0});
  chip_->model().in(17, 0);
  EXPECT_EQ(host_.read(0xa1, 1, 0x0300, 100).value_or(Bytes()).size(), 64u);
}

TEST_P(FirmwareUsbPort, ClearHaltBeginsWithData0) {
  ASSERT_TRUE(host_.enumerate());
  for (int i = 0; i < 3; ++i) {
    run(1000);
    EXPECT_TRUE(host_.report());
    send(message(0x12));
    ASSERT_TRUE(host_.clear_halts());
    run(1000);
    EXPECT_TRUE(is_state(host_.report().value_or(Bytes(64))));
    send(message(0x12));
    ASSERT_TRUE(host_.clear_halts());
  }
}

TEST_P(FirmwareUsbPort, BusResetSwitchesMotorsOffAtOnce) {
  start_driving();
  chip_->model().begin_reset();
  run(kPass_us);
  EXPECT_FALSE(motors_on());
  EXPECT_EQ(usb_board.outputs.amperes[0], 0);
  ASSERT_TRUE(host_.enumerate());
  EXPECT_EQ(field(new_report(), 20, 3), 0x020080u) << "fault, link_lost";
}

TEST_P(FirmwareUsbPort, SuspensionSwitchesMotorsOffAtOnce) {
  start_driving();
  chip_->model().suspend();
  run(kPass_us);
  EXPECT_FALSE(motors_on());
  run(10'000);
  chip_->model().resume();
  EXPECT_EQ(field(new_report(), 20, 3), 0x020080u) << "fault, link_lost";
}

TEST_P(FirmwareUsbPort, DrivesAgainAfterResetAndClear) {
  start_driving();
  start_driving();
  EXPECT_EQ(usb_board.outputs.amperes[0], 0.5f);
}

TEST_P(FirmwareUsbPort, MessageBeforeAResetIsForgotten) {
  ASSERT_TRUE(host_.enumerate());
  run(1000);
  EXPECT_EQ(host_.send(message(0x10, 0.0f)), Handshake::kAck);
  chip_->model().begin_reset();
  run(1000);
  EXPECT_FALSE(motors_on());
  ASSERT_TRUE(host_.enumerate());
  run(50);
  EXPECT_EQ(field(new_report(), 20, 3), 0u);
}

TEST_P(FirmwareUsbPort, ReportThatArrivedBeforeAResetIsForgotten) {
  ASSERT_TRUE(host_.enumerate());
  EXPECT_EQ(host_.send(message(0x12)), Handshake::kAck);
  firmware::board::tick_due();  // the driver has it
  chip_->model().begin_reset();
  firmware::board::tick_due();
  Bytes report(64);
  EXPECT_FALSE(chip_->receive(report.data()));
}

TEST_P(FirmwareUsbPort, IntervalIsThatOfTheSpeed) {
  ASSERT_TRUE(host_.enumerate());
  const auto bytes = host_.descriptor(2);
  ASSERT_TRUE(bytes);
  // 250 us at high speed, 1 ms at full speed (USB 2.0, 9.6.6).
  EXPECT_EQ(bytes->at(33), GetParam().high_speed ? 2 : 1);
  EXPECT_EQ(bytes->at(40), GetParam().high_speed ? 2 : 1);
}

TEST_P(FirmwareUsbPort, OnlyADeviceOfTwoSpeedsDescribesTheOther) {
  ASSERT_TRUE(host_.enumerate());
  EXPECT_EQ(host_.descriptor(6, 0, 10).has_value(), GetParam().offers_high_speed);
  const auto other = host_.descriptor(7);
  ASSERT_EQ(other.has_value(), GetParam().offers_high_speed);
  if (other) {
    EXPECT_EQ(other->at(33), GetParam().high_speed ? 1 : 2);
  }
}

TEST_P(FirmwareUsbPort, EnumeratesAfterAnyTraffic) {
  std::mt19937 random(53);
  const auto byte = [&] { return static_cast<std::uint8_t>(random() & 0xff); };
  DeviceModel& model = chip_->model();
  for (int round = 0; round < 200; ++round) {
    ASSERT_TRUE(host_.enumerate()) << round;
    int setups = 0;
    for (int i = 0; i < 50; ++i) {
      const unsigned endpoint = random() % 2;
      switch (random() % 8) {
        case 0:
          model.setup(17, {byte(), byte(), byte(), byte(), byte(), byte(), byte(), byte()});
          ++setups;
          break;
        case 1: {
          const auto kind = static_cast<std::uint8_t>(random() % 4);
          model.setup(17, {0x80, 6, byte(), kind, 0, 0, byte(), 0});
          ++setups;
          break;
        }
        case 2:
        case 3:
          model.in(17, endpoint);
          break;
        case 4: {
          const int toggle = static_cast<int>(random() % 2);
          model.out(17, endpoint, toggle, Bytes(random() % 65, byte()));
          break;
        }
        case 5:
          model.suspend();
          break;
        case 6:
          model.resume();
          break;
        default:
          break;
      }
      if (random() % 3 != 0) run(kPass_us);
      // At most three setup packets in a row, as controllers count them (RM0090, STUPCNT).
      if (setups < 3) continue;
      setups = 0;
      model.resume();
      model.in(17, 0);
      run(kPass_us);
    }
    model.resume();
  }
  EXPECT_EQ(host_.text(2), "Thimble arm: reference");
}

INSTANTIATE_TEST_SUITE_P(Boards, FirmwareUsbPort,
                         testing::Values(ChipCase{"rp2040", rp2040_usb, false, false},
                                         ChipCase{"stm32f405", stm32f405_usb, false, false},
                                         ChipCase{"teensy4", teensy4_usb, true, true},
                                         ChipCase{"teensy4_full_speed", teensy4_full_speed_usb,
                                                  true, false}),
                         [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace thimble::firmware_test
