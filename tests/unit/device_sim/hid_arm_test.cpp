#include "usb/hid_arm.h"

#include <gtest/gtest.h>

#include <random>

#include "arms/hfab/hfab_report.h"
#include "arms/woody/woody_report.h"
#include "support/boards/usb_host.h"
#include "support/seed.h"
#include "thimble/device_sim/usb/arm_shelf.h"
#include "usb/setup_packet.h"
#include "usb/usb_description.h"

namespace thimble::device_sim::usb {
namespace {

class HidArmTest : public testing::TestWithParam<const char*> {
 protected:
  void SetUp() override {
    auto arm = make_usb_arm(GetParam(), {});
    ASSERT_TRUE(arm.ok());
    arm_ = std::move(*arm);
    hid_ = dynamic_cast<const HidArm*>(arm_.get());
    ASSERT_NE(hid_, nullptr);
    faulty_.emplace(*arm_);
    server_.emplace(*faulty_, "1-1");
    host_.emplace(*server_);
    ASSERT_TRUE(host_->import_device());
    host_->configure();
  }
  void TearDown() override {
    host_.reset();
    server_.reset();
  }
  std::size_t size() const { return hid_->report_size(); }
  bool woody() const { return size() == driver::woody::kReportSize; }

  std::vector<std::byte> message(std::array<std::int16_t, 3> mA) const {
    std::vector<std::byte> bytes(size());
    if (woody()) {
      const auto report = driver::woody::encode_output({.current_mA = mA, .unknown_debug = 0});
      std::copy(report.begin(), report.end(), bytes.begin());
    } else {
      const auto report =
          driver::hfab::encode_output({.current_mA = mA, .command = 0, .attributes = {}});
      std::copy(report.begin(), report.end(), bytes.begin());
    }
    return bytes;
  }
  std::array<std::int32_t, 3> counts_in(const std::vector<std::byte>& bytes) const {
    std::array<std::int32_t, 3> counts{};
    if (woody()) {
      const auto report = driver::woody::decode_input(bytes);
      for (std::size_t i = 0; report && i < 3; ++i) counts[i] = report->counts[i];
    } else {
      const auto report = driver::hfab::decode_input(bytes);
      for (std::size_t i = 0; report && i < 3; ++i) counts[i] = report->counts[i];
    }
    return counts;
  }
  std::uint32_t ask() {
    return host_->ask(hid_->board().in & 0x0fU, static_cast<std::uint32_t>(size()));
  }
  void tell(const std::vector<std::byte>& bytes) { host_->tell(hid_->board().out, bytes); }
  bool answers() const { return hid_->board().report_mode == HidReportMode::kAnswers; }
  /// Sends a message and reads a report in the same frame. A board that answers returns the report
  /// of the previous message.
  std::optional<support::UsbHost::Done> exchange(std::int16_t mA) {
    const std::uint32_t asked = ask();
    tell(message({mA, 0, 0}));
    host_->frames();
    return host_->done(asked);
  }

  std::unique_ptr<UsbArm> arm_;
  const HidArm* hid_ = nullptr;
  std::optional<FaultyDevice> faulty_;
  std::optional<UsbipServer> server_;
  std::optional<support::UsbHost> host_;
};

TEST_P(HidArmTest, ReportsItsPositionWithinHalfACount) {
  int moved = 0;
  std::array<std::int32_t, 3> before{};
  for (int i = 0; i < 3000; ++i) {
    const auto done = exchange(0);
    ASSERT_TRUE(done.has_value());
    ASSERT_EQ(done->data.size(), size());
    const auto counts = counts_in(done->data);
    const ArmTruth truth = arm_->truth();
    EXPECT_EQ(counts, truth.counts);
    // Sampled a frame earlier: a free-running board keeps sending, the other answered at that time.
    if (i > 0) {
      EXPECT_EQ(truth.report_ns, (host_->frame() - 1) * 1'000'000);
    }
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE(std::abs(counts[static_cast<std::size_t>(k)] - truth.exact_counts[k]), 0.5);
    }
    moved += counts != before ? 1 : 0;
    before = counts;
  }
  EXPECT_GT(moved, 1000);
}

TEST_P(HidArmTest, MessageSetsTheMotorCurrents) {
  std::mt19937_64 random(support::seed_of(2));
  for (int i = 0; i < 300; ++i) {
    const auto mA = static_cast<std::int16_t>(static_cast<int>(random() % 5000) - 2500);
    ASSERT_TRUE(exchange(mA).has_value());
    EXPECT_EQ(arm_->truth().motor_values[0], mA);
    EXPECT_NEAR(arm_->truth().currents[0], mA * 1e-3, 1e-12);
  }
}

TEST_P(HidArmTest, ClampsACurrentBeyondItsAmplifiers) {
  exchange(20000);
  EXPECT_EQ(arm_->truth().currents[0], 3);
}

TEST_P(HidArmTest, SwitchesOffHalfASecondAfterTheLastMessage) {
  exchange(1000);
  host_->frames(499);
  EXPECT_TRUE(arm_->truth().motors_on);
  EXPECT_EQ(arm_->truth().currents[0], 1);
  host_->frames(2);
  EXPECT_FALSE(arm_->truth().motors_on);
  EXPECT_EQ(arm_->truth().currents[0], 0);
}

TEST_P(HidArmTest, IgnoresMessagesOfAnotherLengthAndCountsThem) {
  exchange(500);
  for (const std::size_t wrong : {std::size_t{1}, size() - 1, size() / 2}) {
    ask();
    tell(std::vector<std::byte>(wrong, std::byte{0x11}));
    host_->frames(2);
  }
  EXPECT_EQ(hid_->malformed(), 3U);
  EXPECT_EQ(arm_->truth().currents[0], 0.5);
  EXPECT_EQ(arm_->truth().messages, 1U);
}

TEST_P(HidArmTest, MessagesOfAnotherLengthDoNotFeedTheWatchdog) {
  exchange(500);
  ASSERT_TRUE(arm_->truth().motors_on);
  for (int i = 0; i < 510; ++i) {
    ask();
    tell(std::vector<std::byte>(size() - 1, std::byte{0x11}));
    host_->frames();
  }
  EXPECT_FALSE(arm_->truth().motors_on);
  EXPECT_EQ(arm_->truth().currents[0], 0);
}

TEST_P(HidArmTest, ServesOnlyTheHidRequestsOfItsLibrary) {
  const bool teensy = size() == driver::hfab::kPaddedReportSize;
  const auto length = static_cast<std::uint16_t>(size());
  const auto status = [&](const SetupPacket& setup, const std::vector<std::byte>& data = {}) {
    const auto done = host_->control(setup, data);
    return done ? done->status : 1;
  };
  EXPECT_LT(status({.request_type = 0xa1, .request = 1, .value = 0x0100, .length = length}), 0);
  EXPECT_LT(status({.request_type = 0xa1, .request = 2, .length = 1}), 0);
  const auto set_idle = status({.request_type = 0x21, .request = 0x0a, .value = 0x0500});
  EXPECT_EQ(set_idle == 0, teensy);
  // A message through the control pipe moves no motor of any board.
  const auto set_report =
      status({.request_type = 0x21, .request = 9, .value = 0x0200, .length = length},
             message({777, 0, 0}));
  EXPECT_EQ(set_report == 0, teensy);
  EXPECT_EQ(arm_->truth().motor_values[0], 0);
  EXPECT_LT(status({.request_type = 0x21, .request = 0x77}), 0);
  const auto descriptor = host_->control(
      {.request_type = 0x81, .request = 6, .value = 0x2200, .index = 0, .length = 256});
  ASSERT_TRUE(descriptor.has_value());
  EXPECT_EQ(descriptor->data, arm_->description().interfaces[0].report_descriptor);
}

TEST_P(HidArmTest, SendsUnaskedOnlyIfFreeRunning) {
  int reports = 0;
  for (int i = 0; i < 200; ++i) {
    const std::uint32_t asked = ask();
    host_->frames();
    reports += host_->done(asked) ? 1 : 0;
    host_->take_back(asked);
  }
  // The report that the board sent at its start is still waiting.
  EXPECT_EQ(reports, answers() ? 1 : 200);
}

INSTANTIATE_TEST_SUITE_P(Boards, HidArmTest,
                         testing::Values("woodenhaptics", "polhem", "polhem-64"),
                         [](const auto& param_info) {
                           std::string name(param_info.param);
                           std::erase(name, '-');
                           return name;
                         });

/// A board that answers, without a bus.
struct Board {
  explicit Board(const char* name, const HidBoard& kind) : in(kind.in), out(kind.out) {
    auto made = make_usb_arm(name, {});
    EXPECT_TRUE(made.ok());
    arm = std::move(*made);
    size = kind.report_size();
  }
  std::optional<std::int64_t> report() {
    std::array<std::byte, UsbDevice::kPacketMax> packet{};
    if (arm->in(in, packet).answer != Answer::kDone) return std::nullopt;
    return arm->truth().report_ns;
  }
  Answer tell(std::int16_t mA) {
    std::vector<std::byte> bytes(size);
    const auto message = driver::hfab::encode_output({.current_mA = {mA, 0, 0}});
    std::copy(message.begin(), message.end(), bytes.begin());
    return arm->out(out, bytes).answer;
  }
  std::unique_ptr<UsbArm> arm;
  std::uint8_t in, out;
  std::size_t size = 0;
};

class BoardThatAnswers : public testing::TestWithParam<std::pair<const char*, HidBoard>> {};

TEST_P(BoardThatAnswers, SendsOneReportForEachMessage) {
  Board board(GetParam().first, GetParam().second);
  board.arm->advance_to(40'000'000);
  // The report of its start is read first and shows that time, however late it is read.
  EXPECT_EQ(board.report(), 0);
  EXPECT_FALSE(board.report());
  for (std::int64_t ms = 50; ms < 150; ms += 7) {
    board.arm->advance_to(ms * 1'000'000);
    EXPECT_EQ(board.tell(100), Answer::kDone);
    board.arm->advance_to((ms + 3) * 1'000'000);
    EXPECT_EQ(board.report(), ms * 1'000'000);
    EXPECT_FALSE(board.report());
  }
}

TEST_P(BoardThatAnswers, ReadsNoMessageWhileItsReportWaits) {
  Board board(GetParam().first, GetParam().second);
  board.arm->advance_to(1'000'000);
  EXPECT_EQ(board.tell(700), Answer::kDone);  // waits in the endpoint
  EXPECT_EQ(board.arm->truth().messages, 0U);
  EXPECT_EQ(board.tell(800), Answer::kNak);
  board.arm->advance_to(5'000'000);
  EXPECT_EQ(board.report(), 0);
  EXPECT_EQ(board.arm->truth().messages, 1U);
  EXPECT_EQ(board.arm->truth().motor_values[0], 700);
  EXPECT_EQ(board.report(), 5'000'000);
  EXPECT_FALSE(board.report());
}

TEST_P(BoardThatAnswers, WrongLengthIsAnsweredButNotTaken) {
  Board board(GetParam().first, GetParam().second);
  board.report();
  board.arm->advance_to(9'000'000);
  const std::size_t wrong = board.size == 14 ? 64 : 14;
  EXPECT_EQ(board.arm->out(board.out, std::vector<std::byte>(wrong)).answer, Answer::kDone);
  EXPECT_EQ(board.report(), 9'000'000);
  EXPECT_EQ(board.arm->truth().messages, 0U);
  EXPECT_FALSE(board.arm->truth().motors_on);
}

INSTANTIATE_TEST_SUITE_P(Boards, BoardThatAnswers,
                         testing::Values(std::pair("polhem", kMbed14Board),
                                         std::pair("polhem-64", kTeensy64Board)),
                         [](const auto& param_info) {
                           return param_info.param.second.layout == HidLayout::kPolhem ? "mbed"
                                                                                       : "teensy";
                         });

TEST(HidArm, HasADebugInterfaceOnATeensyThatStaysSilent) {
  auto arm = make_usb_arm("polhem-64", {});
  ASSERT_TRUE(arm.ok());
  std::array<std::byte, UsbDevice::kPacketMax> packet{};
  EXPECT_EQ((*arm)->in(0x81, packet).answer, Answer::kNak);
  EXPECT_EQ((*arm)->out(0x02, packet).answer, Answer::kDone);
  EXPECT_EQ((*arm)->truth().messages, 0U);
  EXPECT_EQ((*arm)->in(0x82, packet).answer, Answer::kStall);
  EXPECT_EQ((*arm)->out(0x01, packet).answer, Answer::kStall);
}

TEST(HidArm, CountsTheReportsOfAWoodenHapticsBoard) {
  auto arm = make_usb_arm("woodenhaptics", {});
  ASSERT_TRUE(arm.ok());
  std::array<std::byte, UsbDevice::kPacketMax> packet{};
  for (std::uint16_t i = 1; i < 100; ++i) {
    (*arm)->advance_to(i * 1'000'000);
    ASSERT_EQ((*arm)->in(0x81, packet).answer, Answer::kDone);
    const auto report = driver::woody::decode_input(std::span(packet).first(8));
    ASSERT_TRUE(report.has_value());
    EXPECT_EQ(report->counter, i);
    EXPECT_EQ((*arm)->in(0x81, packet).answer, Answer::kNak);  // one report per frame
  }
}

}  // namespace
}  // namespace thimble::device_sim::usb
