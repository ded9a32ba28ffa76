#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <signal.h>
#include <stdlib.h>
#include <sys/time.h>
#include <termios.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <fstream>
#include <functional>
#include <string>
#include <string_view>
#include <thread>

#include "arms/hfab/hfab_wire.h"
#include "support/scratch.h"
#include "support/vintage_arm.h"
#include "thimble/driver/device.h"
#include "thimble/driver/transports.h"
#include "thimble/driver/wire_link.h"

namespace thimble::driver {
namespace {

/// A serial port whose far end the test holds: a pseudo-terminal.
class SerialTransportTest : public ::testing::Test {
 protected:
  SerialTransportTest() : far_(posix_openpt(O_RDWR | O_NOCTTY | O_NONBLOCK)) {
    if (far_ < 0 || grantpt(far_) != 0 || unlockpt(far_) != 0) far_ = -1;
  }
  ~SerialTransportTest() override { hang_up(); }

  /// Repeats a call until no signal interrupts it.
  static ssize_t unstopped(const std::function<ssize_t()>& call) {
    ssize_t count = 0;
    do count = call();
    while (count < 0 && errno == EINTR);
    return count;
  }
  void open() {
    ASSERT_GE(far_, 0);
    auto opened = open_serial_transport(ptsname(far_), hfab::kLineFraming, clock_);
    ASSERT_TRUE(opened) << opened.error().message;
    wire_ = std::move(opened).value();
  }
  void hang_up() {
    if (far_ >= 0) close(far_);
    far_ = -1;
  }
  void say(std::string_view text) const {
    ASSERT_EQ(::write(far_, text.data(), text.size()), static_cast<ssize_t>(text.size()));
  }
  std::string hear() const {
    std::string text(256, '\0');
    const ssize_t count = unstopped([&] { return ::read(far_, text.data(), text.size()); });
    text.resize(count > 0 ? static_cast<std::size_t>(count) : 0);
    return text;
  }
  std::string read(std::int64_t wait_ns = 1'000'000'000) {
    std::array<std::byte, kReportCapacity> buffer{};
    last_ = wire_->read_latest(buffer, clock_.now_ns() + wait_ns);
    return {reinterpret_cast<const char*>(buffer.data()), last_.size};
  }
  TransportStatus write(std::string_view text) {
    return wire_->write({reinterpret_cast<const std::byte*>(text.data()), text.size()});
  }

  int far_;
  WallClock clock_;
  std::unique_ptr<Transport> wire_;
  TransportRead last_;
};

TEST_F(SerialTransportTest, CarriesEveryByteUnchangedBothWays) {
  open();
  EXPECT_EQ(write("[1,-2,3]\n"), TransportStatus::kOk);
  EXPECT_EQ(hear(), "[1,-2,3]\n");  // no newline is doubled, nothing is echoed
  say("[3,1,2,3,4,5,6,0]\n");
  EXPECT_EQ(read(), "[3,1,2,3,4,5,6,0]");
}

TEST_F(SerialTransportTest, SetsTheBaudRateOfTheDevice) {
  open();
  termios settings{};
  ASSERT_EQ(tcgetattr(far_, &settings), 0);
  EXPECT_EQ(cfgetospeed(&settings), speed_t{B115200});
  EXPECT_EQ(cfgetispeed(&settings), speed_t{B115200});
}

TEST_F(SerialTransportTest, DropsBytesReceivedBeforeOpening) {
  const int before = ::open(ptsname(far_), O_RDWR | O_NOCTTY);
  ASSERT_GE(before, 0);
  say("[9]\n");
  pollfd port{.fd = before, .events = POLLIN, .revents = 0};
  ASSERT_EQ(poll(&port, 1, 10'000), 1);
  open();
  EXPECT_EQ(read(0), "");
  say("[3]\n");
  EXPECT_EQ(read(), "[3]");
  close(before);
}

TEST_F(SerialTransportTest, JoinsPiecesAndTakesTheNewest) {
  open();
  say("[1,1,");
  EXPECT_EQ(read(0), "");
  EXPECT_EQ(last_.status, TransportStatus::kNothing);
  say("2]\n[2]\n[3]\n");
  EXPECT_EQ(read(), "[3]");
  EXPECT_EQ(last_.skipped, 2u);
}

TEST_F(SerialTransportTest, HangUpIsALostArm) {
  open();
  hang_up();
  read();
  EXPECT_EQ(last_.status, TransportStatus::kLost);
  EXPECT_EQ(write("[0,0,0]\n"), TransportStatus::kLost);
}

// The end of the file is no error, so `errno` is that of an earlier call.
TEST_F(SerialTransportTest, EndOfTheFileIsALostArmAfterAnyError) {
  open();
  hang_up();
  for (const int error : {EINTR, EAGAIN}) {
    errno = error;
    read(0);
    EXPECT_EQ(last_.status, TransportStatus::kLost) << error;
  }
}

TEST_F(SerialTransportTest, FullPortRefusesInsteadOfWaiting) {
  open();
  const std::string line = "[" + std::string(90, '1') + "]\n";
  int refused = 0;
  for (int i = 0; i < 5000 && refused == 0; ++i) {
    refused += write(line) == TransportStatus::kRefused ? 1 : 0;
  }
  EXPECT_EQ(refused, 1);
}

TEST_F(SerialTransportTest, CompletesAMessageThatWasTorn) {
  open();
  // A nearly full port accepts only a part of a message, which must not merge with the next one.
  std::string heard;
  int refused = 0;
  for (int i = 0; i < 20'000 && refused < 300; ++i) {
    const std::size_t length = 20 + static_cast<std::size_t>(i % 60);
    const auto status = write("[" + std::string(length, '1') + "]\n");
    refused += status == TransportStatus::kRefused ? 1 : 0;
    if (status == TransportStatus::kRefused && i % 3 == 0) heard += hear();
  }
  ASSERT_GE(refused, 300);
  for (std::string more = hear(); !more.empty(); more = hear()) heard += more;
  EXPECT_EQ(write("[2]\n"), TransportStatus::kOk);
  EXPECT_EQ(wire_->settled(), TransportStatus::kOk);
  // The kernel hands bytes on in its own time.
  for (int i = 0; i < 500 && !heard.ends_with("[2]\n"); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(i == 0 ? 0 : 10));
    heard += hear();
  }
  EXPECT_EQ(heard.find("1[1"), std::string::npos) << "a torn message merges with the next";
  ASSERT_GE(heard.size(), 4U);
  EXPECT_EQ(heard.substr(heard.size() - 5), "\n[2]\n");
}

TEST_F(SerialTransportTest, SurvivesSignals) {
  open();
  struct sigaction noted {};
  noted.sa_handler = [](int) {};  // without SA_RESTART
  struct sigaction before {};
  ASSERT_EQ(sigaction(SIGALRM, &noted, &before), 0);
  const itimerval often{.it_interval = {0, 100}, .it_value = {0, 100}};
  ASSERT_EQ(setitimer(ITIMER_REAL, &often, nullptr), 0);
  int answered = 0;
  for (int i = 0; i < 500; ++i) {
    if (write("[1,2,3]\n") != TransportStatus::kOk) continue;
    read(2'000'000);  // nothing arrives: it waits despite signals
    std::string text = hear();
    const ssize_t said = unstopped([&] { return ::write(far_, text.data(), text.size()); });
    answered += said > 0 && read() == "[1,2,3]" ? 1 : 0;
  }
  const itimerval never{};
  setitimer(ITIMER_REAL, &never, nullptr);
  sigaction(SIGALRM, &before, nullptr);
  EXPECT_EQ(answered, 500);
  EXPECT_NE(last_.status, TransportStatus::kLost);
}

TEST_F(SerialTransportTest, OpenErrorNamesTheReason) {
  const auto missing = open_serial_transport("/dev/no_such_arm", hfab::kLineFraming, clock_);
  ASSERT_FALSE(missing);
  EXPECT_NE(missing.error().message.find("plugged in"), std::string::npos);
  const std::string file = (support::scratch_folder() / "no_port").string();
  std::ofstream(file) << "";
  const auto no_port = open_serial_transport(file, hfab::kLineFraming, clock_);
  ASSERT_FALSE(no_port);
  EXPECT_NE(no_port.error().message.find("not a serial port"), std::string::npos);
}

TEST_F(SerialTransportTest, BelongsToOneUserAtATime) {
  open();
  const auto second = open_serial_transport(ptsname(far_), hfab::kLineFraming, clock_);
  ASSERT_FALSE(second);
  EXPECT_NE(second.error().message.find("in use"), std::string::npos);
  wire_.reset();
  open();
}

TEST_F(SerialTransportTest, OpeningSendsNothing) {
  open();
  EXPECT_EQ(hear(), "");
  wire_.reset();
  EXPECT_EQ(hear(), "");
}

TEST_F(SerialTransportTest, CarriesAWholeArm) {
  open();
  say("[2,100,-50,7,0,0,0,0]\n");
  JointModel<SerialArm> model;
  const auto vintage = support::vintage_model();
  model.geometry = vintage.geometry;
  model.drives = vintage.drives;
  model.encoders = vintage.encoders;
  auto device = Device::open(
      std::make_unique<WireLink>(std::move(wire_),
                                 std::make_unique<WireArm<hfab::LineWire, SerialArm>>(model)),
      support::vintage_settings(), clock_.now_ns());
  ASSERT_TRUE(device) << device.error().message;
  EXPECT_EQ((*device)->state().counts, (std::array<std::int32_t, 3>{100, -50, 7}));
  EXPECT_EQ(hear(), "[0,0,0]\n");
}

}  // namespace
}  // namespace thimble::driver
