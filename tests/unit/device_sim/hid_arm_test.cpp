#include "thimble/device_sim/usb/hid_arm.h"

#include <gtest/gtest.h>

#include <random>

#include "support/usb_host.h"
#include "thimble/device_sim/usb/arm_shelf.h"
#include "thimble/driver/arms/hfab/hfab_report.h"
#include "thimble/driver/arms/woody/woody_report.h"

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
  std::optional<support::UsbHost::Done> exchange(std::int16_t mA) {
    const std::uint32_t asked = host_->ask(1, static_cast<std::uint32_t>(size()));
    host_->tell(1, message({mA, 0, 0}));
    host_->frames();
    return host_->done(asked);
  }

  std::unique_ptr<UsbArm> arm_;
  const HidArm* hid_ = nullptr;
  std::optional<FaultyDevice> faulty_;
  std::optional<UsbipServer> server_;
  std::optional<support::UsbHost> host_;
};

TEST_P(HidArmTest, SaysWhereItIsWithinHalfACount) {
  int moved = 0;
  std::array<std::int32_t, 3> before{};
  for (int i = 0; i < 3000; ++i) {
    const auto done = exchange(0);
    ASSERT_TRUE(done.has_value());
    ASSERT_EQ(done->data.size(), size());
    const auto counts = counts_in(done->data);
    const ArmTruth truth = arm_->truth();
    EXPECT_EQ(counts, truth.counts);
    EXPECT_EQ(truth.report_ns, (host_->frame() - 1) * 1'000'000);  // sampled a frame before
    for (int k = 0; k < 3; ++k) {
      EXPECT_LE(std::abs(counts[static_cast<std::size_t>(k)] - truth.exact_counts[k]), 0.5);
    }
    moved += counts != before ? 1 : 0;
    before = counts;
  }
  EXPECT_GT(moved, 1000);
}

TEST_P(HidArmTest, FeedsItsMotorsWhatTheMessageSays) {
  std::mt19937_64 random(2);
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
    host_->tell(1, std::vector<std::byte>(wrong, std::byte{0x11}));
    host_->frames();
  }
  EXPECT_EQ(hid_->malformed(), 3U);
  EXPECT_EQ(arm_->truth().currents[0], 0.5);
}

TEST_P(HidArmTest, AnswersTheRequestsOfTheHidClass) {
  const auto done = exchange(0);
  ASSERT_TRUE(done.has_value());
  const auto length = static_cast<std::uint16_t>(size());
  const auto got = host_->control(
      {.request_type = 0xa1, .request = 1, .value = 0x0100, .index = 0, .length = length});
  ASSERT_TRUE(got.has_value());
  EXPECT_EQ(got->data, done->data);
  const auto set = host_->control(
      {.request_type = 0x21, .request = 9, .value = 0x0200, .index = 0, .length = length},
      message({777, 0, 0}));
  ASSERT_TRUE(set.has_value());
  EXPECT_EQ(set->status, 0);
  EXPECT_EQ(arm_->truth().motor_values[0], 777);
  ASSERT_EQ(host_->control({.request_type = 0x21, .request = 0x0a, .value = 0x0500})->status, 0);
  EXPECT_EQ(host_->control({.request_type = 0xa1, .request = 2, .length = 1})->data[0],
            std::byte{5});
  const auto descriptor = host_->control(
      {.request_type = 0x81, .request = 6, .value = 0x2200, .index = 0, .length = 256});
  ASSERT_TRUE(descriptor.has_value());
  EXPECT_EQ(descriptor->data, arm_->description().report_descriptor);
  EXPECT_LT(host_->control({.request_type = 0x21, .request = 0x77})->status, 0);
}

INSTANTIATE_TEST_SUITE_P(Boards, HidArmTest,
                         testing::Values("woodenhaptics", "polhem", "polhem-64"),
                         [](const auto& param_info) {
                           std::string name(param_info.param);
                           std::erase(name, '-');
                           return name;
                         });

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
    EXPECT_EQ((*arm)->in(0x81, packet).answer, Answer::kNak);  // one report a frame
  }
}

}  // namespace
}  // namespace thimble::device_sim::usb
