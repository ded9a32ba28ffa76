// The wires to real arms over scripted libraries: bus events that a virtual machine cannot time,
// and no allocation by any wire after it is opened.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <libusb-1.0/libusb.h>
#include <stdlib.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <string>
#include <string_view>

#include "arms/woody/woody_proof.h"
#include "support/heap_guard.h"
#include "support/mock/fake_hidapi.h"
#include "support/mock/fake_libusb.h"
#include "support/scratch.h"
#include "thimble/driver/transports.h"
#include "transports/ftdi_line.h"
#include "transports/ftdi_transport.h"
#include "wires/wire_table.h"

namespace thimble::driver {
namespace {

constexpr Framing kBrackets{.begin = std::byte{'<'}, .end = std::byte{'>'}, .size_max = 16};
constexpr std::string_view kMessage = "<0123456789abcd>";

std::span<const std::byte> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

class FtdiWire : public ::testing::Test {
 protected:
  void SetUp() override { usb_.reset(); }

  void open() {
    auto line = FtdiLine::open({.bus = 1, .device = 7});
    ASSERT_TRUE(line) << line.error().message;
    auto wire = (*line)->into_transport(kBrackets, clock_);
    ASSERT_TRUE(wire) << wire.error().message;
    wire_ = std::move(wire).value();
  }
  std::string read() {
    std::array<std::byte, 64> buffer{};
    last_ = wire_->read_latest(buffer, clock_.now_ns());
    return {reinterpret_cast<const char*>(buffer.data()), last_.size};
  }
  TransportStatus write(std::string_view text = kMessage) { return wire_->write(bytes_of(text)); }

  support::FakeLibusb& usb_ = support::fake_libusb();
  WallClock clock_;
  std::unique_ptr<Transport> wire_;
  TransportRead last_;
};

TEST_F(FtdiWire, DoesNotAllocateAfterOpening) {
  usb_.answers = true;
  usb_.answer = "<aaaabbbbccccdd>";
  open();
  int answered = 0;
  const int calls = support::heap_calls_of([&] {
    std::array<std::byte, 64> buffer{};
    for (int tick = 0; tick < 2000; ++tick) {
      answered += wire_->read_latest(buffer, clock_.now_ns()).size == 16 ? 1 : 0;
      wire_->write(bytes_of(kMessage));
    }
  });
  EXPECT_EQ(calls, 0);
  EXPECT_GT(answered, 1900);
  EXPECT_GT(usb_.messages, 1990u);
  EXPECT_EQ(
      std::string(reinterpret_cast<const char*>(usb_.last_message.data()), usb_.last_message_size),
      kMessage);
}

TEST_F(FtdiWire, DoesNotAllocateWhenTheArmFails) {
  open();
  for (int i = 0; i < 500; ++i) usb_.say(i % 3 == 0 ? "<torn" : "no message");
  for (int i = 0; i < 5; ++i) usb_.fail(LIBUSB_TRANSFER_STALL);
  usb_.fail(LIBUSB_TRANSFER_NO_DEVICE);
  const int calls = support::heap_calls_of([&] {
    std::array<std::byte, 64> buffer{};
    for (int tick = 0; tick < 600; ++tick) {
      last_ = wire_->read_latest(buffer, clock_.now_ns());
      wire_->write(bytes_of(kMessage));
    }
  });
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(last_.status, TransportStatus::kLost);
}

TEST_F(FtdiWire, JoinsPacketsAndReturnsTheNewestMessage) {
  open();
  usb_.say("noise<01234");
  usb_.say("56789>");
  usb_.say("");  // a packet with only status bytes
  EXPECT_EQ(read(), "<0123456789>");
  usb_.say("<1><2>");
  usb_.say("<3>");
  EXPECT_EQ(read(), "<3>");
  EXPECT_EQ(last_.skipped, 2u);
  EXPECT_EQ(read(), "");
  EXPECT_EQ(last_.status, TransportStatus::kNothing);
}

TEST_F(FtdiWire, ManyFailedReadsInARowAreALostArm) {
  open();
  for (const int status : {LIBUSB_TRANSFER_STALL, LIBUSB_TRANSFER_OVERFLOW, LIBUSB_TRANSFER_ERROR,
                           LIBUSB_TRANSFER_TIMED_OUT}) {
    for (int i = 0; i < 7; ++i) usb_.fail(status);
    usb_.say("<ok>");
    for (int i = 0; i < 10 && read() != "<ok>"; ++i) {
    }
    ASSERT_EQ(last_.status, TransportStatus::kOk) << status;
  }
  for (int i = 0; i < 9; ++i) usb_.fail(LIBUSB_TRANSFER_STALL);
  for (int i = 0; i < 10; ++i) read();
  EXPECT_EQ(last_.status, TransportStatus::kLost);
  EXPECT_EQ(write(), TransportStatus::kLost);
}

TEST_F(FtdiWire, AReadMessageStartsTheCountOfFailedReadsAgain) {
  open();
  usb_.say("<ok>");
  ASSERT_EQ(read(), "<ok>");
  for (int i = 0; i < 8; ++i) usb_.fail(LIBUSB_TRANSFER_STALL);
  for (int i = 0; i < 10; ++i) read();
  EXPECT_EQ(last_.status, TransportStatus::kNothing);
  usb_.fail(LIBUSB_TRANSFER_STALL);
  read();
  EXPECT_EQ(last_.status, TransportStatus::kLost) << "the ninth in a row";
}

TEST_F(FtdiWire, TransfersWaitWithoutATimeLimit) {
  usb_.takes = false;
  open();
  ASSERT_EQ(write(), TransportStatus::kOk);
  int transfers = 0;
  for (const void* waiting : usb_.waiting) {
    if (waiting == nullptr) continue;
    ++transfers;
    EXPECT_EQ(static_cast<const libusb_transfer*>(waiting)->timeout, 0U);
  }
  EXPECT_EQ(transfers, usb_.under_way);
}

TEST_F(FtdiWire, DisconnectedArmIsLost) {
  open();
  usb_.fail(LIBUSB_TRANSFER_NO_DEVICE);
  read();
  EXPECT_EQ(last_.status, TransportStatus::kLost);
  EXPECT_EQ(write(), TransportStatus::kLost);
}

TEST_F(FtdiWire, WriteDetectsALostArm) {
  open();
  usb_.submit_code = LIBUSB_ERROR_NO_DEVICE;
  EXPECT_EQ(write(), TransportStatus::kLost);
  EXPECT_EQ(read(), "");
  EXPECT_EQ(last_.status, TransportStatus::kLost);
}

TEST_F(FtdiWire, RefusesAThirdPendingMessage) {
  usb_.takes = false;
  open();
  EXPECT_EQ(write(), TransportStatus::kOk);
  EXPECT_EQ(write(), TransportStatus::kOk);
  EXPECT_EQ(write(), TransportStatus::kRefused);
  usb_.takes = true;
  EXPECT_EQ(write(), TransportStatus::kOk);
  usb_.write_status = LIBUSB_TRANSFER_STALL;
  write();
  EXPECT_EQ(write(), TransportStatus::kRefused);
}

TEST_F(FtdiWire, ReportsTheResultOfTheLastMessage) {
  open();
  EXPECT_EQ(wire_->settled(), TransportStatus::kOk);
  usb_.takes = false;
  EXPECT_EQ(write(), TransportStatus::kOk);
  EXPECT_EQ(wire_->settled(), TransportStatus::kNothing);
  usb_.takes = true;
  EXPECT_EQ(wire_->settled(), TransportStatus::kOk);
  usb_.write_status = LIBUSB_TRANSFER_STALL;
  EXPECT_EQ(write(), TransportStatus::kOk) << "its failure is known only later";
  EXPECT_EQ(wire_->settled(), TransportStatus::kRefused);
  usb_.write_status = 0;
  EXPECT_EQ(write(), TransportStatus::kRefused);
  EXPECT_EQ(wire_->settled(), TransportStatus::kOk) << "it was handed to the bus nevertheless";
  usb_.takes = false;
  write();
  usb_.fail(LIBUSB_TRANSFER_NO_DEVICE);
  read();
  EXPECT_EQ(wire_->settled(), TransportStatus::kLost);
}

TEST_F(FtdiWire, SurvivesSignals) {
  usb_.answers = true;
  usb_.answer = "<ok>";
  open();
  for (int k = 0; k < 20; ++k) {
    usb_.interruptions = k % 8;
    EXPECT_EQ(write(), TransportStatus::kOk);
    usb_.interruptions = k % 8;
    EXPECT_EQ(read(), "<ok>") << k;
  }
  usb_.interruptions = 3;
  wire_.reset();
  EXPECT_EQ(usb_.under_way, 0);
}

TEST_F(FtdiWire, ClosesAndCancelsEverything) {
  for (const bool takes : {true, false}) {
    usb_.reset();
    usb_.takes = takes;
    open();
    EXPECT_EQ(usb_.transfers, 4);
    EXPECT_EQ(usb_.under_way, 2);
    write();
    wire_.reset();
    EXPECT_EQ(usb_.transfers, 0);
    EXPECT_EQ(usb_.under_way, 0);
    EXPECT_EQ(usb_.claimed, 0);
    EXPECT_EQ(usb_.handles, 0);
    EXPECT_EQ(usb_.contexts, 0);
  }
}

TEST_F(FtdiWire, ClearsHaltedEndpoints) {
  open();
  EXPECT_EQ(usb_.cleared_halts, 2);
}

TEST_F(FtdiWire, BulkBoardHasNoStatusBytes) {
  // The scripted converter puts two status bytes in front; a described board has none, so they are
  // content here.
  const BulkEnds ends{.in = 0x82, .out = 0x03, .ftdi = false};
  auto device = open_bulk_device({.bus = 1, .device = 7}, ends);
  ASSERT_TRUE(device) << device.error().message;
  WireLayout layout;
  layout.framing = WireFraming::kFixed;
  layout.size = layout.padded = 5;
  auto wire = start_ftdi_transport(std::move(device).value(), {.described = &layout}, clock_, ends);
  ASSERT_TRUE(wire) << wire.error().message;
  wire_ = std::move(wire).value();
  usb_.say("abc");
  const std::string message = read();
  EXPECT_EQ(message.size(), 5u);
  EXPECT_EQ(message.substr(2), "abc");
}

TEST_F(FtdiWire, OpenErrorNamesTheReason) {
  const auto message = [this](int code) {
    usb_.open_code = code;
    const auto line = FtdiLine::open({.bus = 1, .device = 7});
    return line ? std::string() : line.error().message;
  };
  EXPECT_NE(message(LIBUSB_ERROR_ACCESS).find("70-thimble.rules"), std::string::npos);
  EXPECT_NE(message(LIBUSB_ERROR_BUSY).find("in use"), std::string::npos);
  EXPECT_FALSE(FtdiLine::open({.bus = 2, .device = 7}));
  EXPECT_EQ(usb_.contexts, 0);
}

class HidWire : public ::testing::Test {
 protected:
  void SetUp() override {
    hid_ = {};
    hid_.report_bytes = 14;
    node_ = (support::scratch_folder() / "hid_wire_node").string();
    std::ofstream(node_) << "";
    open(14);
  }
  void open(std::size_t message_size) {
    wire_.reset();
    auto wire = open_hid_transport(node_, message_size, clock_);
    ASSERT_TRUE(wire) << wire.error().message;
    wire_ = std::move(wire).value();
  }
  std::string refusal(std::size_t message_size) {
    const auto wire = open_hid_transport(node_, message_size, clock_);
    return wire ? "" : wire.error().message;
  }

  std::string node_;
  support::FakeHidapi& hid_ = support::fake_hidapi();
  VirtualClock clock_;
  std::unique_ptr<Transport> wire_;
  std::array<std::byte, 64> buffer_{};
};

TEST_F(HidWire, DoesNotAllocateAfterOpening) {
  int read = 0;
  const int calls = support::heap_calls_of([&] {
    for (int tick = 0; tick < 2000; ++tick) {
      hid_.reports = tick % 4;
      hid_.write_error = tick % 7 == 0 ? EPIPE : 0;
      read += wire_->read_latest(buffer_, 0).status == TransportStatus::kOk ? 1 : 0;
      wire_->write(bytes_of("12345678"));
    }
    hid_.gone = true;
    wire_->read_latest(buffer_, 0);
  });
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(read, 1500);
}

TEST_F(HidWire, TakesTheNewestReportAndCountsTheOlder) {
  hid_.reports = 5;
  const TransportRead read = wire_->read_latest(buffer_, 0);
  EXPECT_EQ(read.status, TransportStatus::kOk);
  EXPECT_EQ(read.skipped, 4u);
  EXPECT_EQ(buffer_[0], std::byte{5});
}

TEST_F(HidWire, WaitsForTheNextReportAfterAnOverflow) {
  hid_.reports = 63;
  hid_.coming = 2;
  TransportRead read = wire_->read_latest(buffer_, 0);
  EXPECT_EQ(read.status, TransportStatus::kOk);
  EXPECT_EQ(read.skipped, 63u);
  EXPECT_EQ(buffer_[0], std::byte{64});

  hid_.reports = 62;
  read = wire_->read_latest(buffer_, 0);
  EXPECT_EQ(read.skipped, 61u);
  EXPECT_EQ(hid_.coming, 1);

  hid_.reports = 63;
  hid_.coming = 0;
  EXPECT_EQ(wire_->read_latest(buffer_, 0).status, TransportStatus::kOk);
}

TEST_F(HidWire, WaitsForWholeMillisecondsWithinTheDeadline) {
  EXPECT_EQ(wire_->read_latest(buffer_, 2'900'000).status, TransportStatus::kNothing);
  EXPECT_EQ(hid_.last_timeout_ms, 2);
  wire_->read_latest(buffer_, 900'000);
  EXPECT_EQ(hid_.last_timeout_ms, 0);
}

TEST_F(HidWire, PrependsTheReportIdAndPadsWithZeros) {
  EXPECT_EQ(wire_->write(bytes_of("12345678")), TransportStatus::kOk);
  ASSERT_EQ(hid_.last_message_size, 15u);
  EXPECT_EQ(hid_.last_message[0], 0);
  EXPECT_EQ(hid_.last_message[1], '1');
  EXPECT_EQ(hid_.last_message[9], 0);
}

TEST_F(HidWire, DistinguishesARefusalFromALostArm) {
  for (const int error : {EPIPE, ETIMEDOUT, EAGAIN, EPROTO}) {
    hid_.write_error = error;
    EXPECT_EQ(wire_->write(bytes_of("12345678")), TransportStatus::kRefused) << error;
  }
  hid_.write_error = 0;
  EXPECT_EQ(wire_->write(bytes_of("12345678")), TransportStatus::kOk);
  hid_.write_error = ENODEV;
  EXPECT_EQ(wire_->write(bytes_of("12345678")), TransportStatus::kLost);
  EXPECT_EQ(wire_->read_latest(buffer_, 0).status, TransportStatus::kLost);
}

TEST_F(HidWire, SurvivesSignals) {
  for (int interruptions = 1; interruptions <= 5; ++interruptions) {
    hid_.interruptions = interruptions;
    hid_.reports = 2;
    const TransportRead read = wire_->read_latest(buffer_, 0);
    EXPECT_EQ(read.status, TransportStatus::kOk);
    EXPECT_EQ(read.skipped, 1u);
    hid_.interruptions = interruptions;
    EXPECT_EQ(wire_->write(bytes_of("12345678")), TransportStatus::kOk);
  }
  EXPECT_EQ(hid_.messages, 5u);
}

TEST_F(HidWire, IsNotLostInAStormOfSignals) {
  hid_.interruptions = 1'000'000;
  EXPECT_EQ(wire_->read_latest(buffer_, 5'000'000).status, TransportStatus::kNothing);
  EXPECT_EQ(wire_->write(bytes_of("12345678")), TransportStatus::kRefused);
  EXPECT_GT(hid_.interruptions, 999'000) << "the loop is not delayed";
  hid_.interruptions = 0;
  hid_.reports = 1;
  EXPECT_EQ(wire_->read_latest(buffer_, 0).status, TransportStatus::kOk);
}

TEST_F(HidWire, RefusesToOpenWithAnotherMessageLength) {
  wire_.reset();
  EXPECT_NE(refusal(64).find("takes messages of 14 bytes, but this arm's are 64"),
            std::string::npos);
  EXPECT_NE(refusal(8), "");
  hid_.report_bytes = 0;
  EXPECT_NE(refusal(14).find("not a usable HID device"), std::string::npos);
  EXPECT_EQ(hid_.open, 0);
  EXPECT_EQ(hid_.messages, 0u);
}

TEST_F(HidWire, RefusesAMessageOfAnotherLength) {
  open(0);  // messages are sent unchanged
  EXPECT_EQ(wire_->write(bytes_of("12345678")), TransportStatus::kRefused);
  EXPECT_EQ(hid_.messages, 0u);
  EXPECT_EQ(wire_->write(bytes_of("12345678901234")), TransportStatus::kOk);
}

TEST_F(HidWire, BelongsToOneProgramAtATime) {
  EXPECT_NE(refusal(14).find("in use"), std::string::npos);
  EXPECT_EQ(hid_.open, 1);
  wire_.reset();
  EXPECT_EQ(refusal(14), "");
}

TEST_F(HidWire, ListensToAWoodenHapticsBoardBeforeItSendsAnything) {
  hid_.report_bytes = 8;
  open(8);
  hid_.coming = 1000;
  EXPECT_FALSE(woody::listen_for_board(*wire_, WallClock()));  // numbers at the wrong position
  hid_.coming = 1000;
  hid_.numbered_last = true;
  EXPECT_TRUE(woody::listen_for_board(*wire_, WallClock()));
  EXPECT_EQ(hid_.messages, 0u);
}

TEST_F(HidWire, ClosesItsDevice) {
  EXPECT_EQ(hid_.open, 1);
  wire_.reset();
  EXPECT_EQ(hid_.open, 0);
}

TEST(SerialWire, DoesNotAllocateAfterOpening) {
  const int far = posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK);
  if (far < 0 || grantpt(far) != 0 || unlockpt(far) != 0) GTEST_SKIP() << "no pseudo-terminals";
  const WallClock clock;
  auto wire = open_serial_transport(ptsname(far), kBrackets, clock);
  ASSERT_TRUE(wire) << wire.error().message;
  int answered = 0;
  const int calls = support::heap_calls_of([&] {
    std::array<std::byte, 64> buffer{};
    for (int tick = 0; tick < 1000; ++tick) {
      (*wire)->write(bytes_of(kMessage));
      std::array<char, 64> heard{};
      const ssize_t size = ::read(far, heard.data(), heard.size());
      if (size > 0) (void)!::write(far, heard.data(), static_cast<std::size_t>(size));
      answered += (*wire)->read_latest(buffer, clock.now_ns() + 100'000'000).size == 16 ? 1 : 0;
    }
  });
  close(far);
  EXPECT_EQ(calls, 0);
  EXPECT_EQ(answered, 1000);
}

}  // namespace
}  // namespace thimble::driver
