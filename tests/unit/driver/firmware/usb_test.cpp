#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <string>
#include <vector>

#include "firmware/usb/hid_device.h"
#include "support/noise.h"
#include "transports/hid_descriptor.h"

namespace thimble::firmware::test {
namespace {

constexpr std::array<std::uint8_t, 8> kSerial{0x12, 0x34, 0, 0, 0, 0, 0xab, 0xcd};

class FirmwareUsb : public testing::Test {
 protected:
  UsbReply ask(std::uint8_t type, std::uint8_t request, std::uint16_t value, std::uint16_t length) {
    const std::array<std::uint8_t, 8> packet{type,
                                             request,
                                             static_cast<std::uint8_t>(value & 0xff),
                                             static_cast<std::uint8_t>(value >> 8),
                                             0,
                                             0,
                                             static_cast<std::uint8_t>(length & 0xff),
                                             static_cast<std::uint8_t>(length >> 8)};
    return device_.setup(packet.data());
  }
  std::vector<std::uint8_t> descriptor(std::uint8_t kind, std::uint8_t index = 0,
                                       std::uint16_t length = 255) {
    const auto value = static_cast<std::uint16_t>(kind << 8 | index);
    const UsbReply reply = ask(kind >= 0x20 ? 0x81 : 0x80, 6, value, length);
    EXPECT_EQ(reply.kind, UsbReply::kSend);
    return {reply.data, reply.data + reply.size};
  }
  std::string text(std::uint8_t index) {
    const auto bytes = descriptor(3, index);
    EXPECT_EQ(bytes.at(0), bytes.size());
    std::string text;
    for (std::size_t i = 2; i < bytes.size(); i += 2) text += static_cast<char>(bytes[i]);
    return text;
  }

  HidDevice device_{"Thimble arm: reference", kSerial.data()};
};

TEST_F(FirmwareUsb, ReportDescriptorIsTheOneOfTheReadme) {
  const auto bytes = descriptor(0x22);
  const auto reports = driver::read_hid_descriptor(std::as_bytes(std::span(bytes)));
  EXPECT_EQ(reports.usage_page, 0xff54);
  EXPECT_EQ(reports.usage, 1);
  EXPECT_EQ(reports.in_bytes, 64u);
  EXPECT_EQ(reports.out_bytes, 64u);
  EXPECT_FALSE(reports.numbered);
}

TEST_F(FirmwareUsb, TextsNameArmMakerAndSerialNumber) {
  EXPECT_EQ(text(1), "thimble");
  EXPECT_EQ(text(2), "Thimble arm: reference");
  EXPECT_EQ(text(3), "123400000000abcd");
}

TEST_F(FirmwareUsb, ConfigurationIsConsistent) {
  const auto bytes = descriptor(2);
  ASSERT_EQ(bytes.size(), bytes.at(2) | bytes.at(3) << 8);
  int interfaces = 0, endpoints = 0, reports = 0;
  for (std::size_t at = 0; at < bytes.size(); at += bytes[at]) {
    ASSERT_GT(bytes[at], 1);
    interfaces += bytes[at + 1] == 4;
    endpoints += bytes[at + 1] == 5;
    if (bytes[at + 1] != 0x21) continue;
    ++reports;
    EXPECT_EQ(bytes[at + 7], descriptor(0x22).size());
  }
  EXPECT_EQ(interfaces, 1);
  EXPECT_EQ(endpoints, 2);
  EXPECT_EQ(reports, 1);
}

TEST_F(FirmwareUsb, AnswersAreNoLongerThanAskedFor) {
  EXPECT_EQ(descriptor(1, 0, 8).size(), 8u);
  EXPECT_EQ(descriptor(2, 0, 9).size(), 9u);
}

TEST_F(FirmwareUsb, FeatureReportIsTheSelfDescription) {
  std::array<std::uint8_t, 64> description{};
  description[0] = 2;
  description[63] = 9;
  device_.set_feature(description.data());
  const UsbReply reply = ask(0xa1, 1, 0x0300, 64);
  ASSERT_EQ(reply.kind, UsbReply::kSend);
  ASSERT_EQ(reply.size, 64);
  EXPECT_EQ(std::memcmp(reply.data, description.data(), 64), 0);
}

TEST_F(FirmwareUsb, IsConfiguredByItsOnlyConfigurationUntilReset) {
  EXPECT_EQ(ask(0, 9, 2, 0).kind, UsbReply::kStall);
  EXPECT_FALSE(device_.configured());
  EXPECT_EQ(ask(0, 9, 1, 0).kind, UsbReply::kOpenEndpoints);
  EXPECT_TRUE(device_.configured());
  device_.reset();
  EXPECT_FALSE(device_.configured());
}

TEST_F(FirmwareUsb, IsConnectedOnlyIfConfiguredAndNotSuspended) {
  EXPECT_FALSE(device_.connected());
  ask(0, 9, 1, 0);
  EXPECT_TRUE(device_.connected());
  device_.suspend();
  EXPECT_FALSE(device_.connected());
  device_.resume();
  EXPECT_TRUE(device_.connected());
}

TEST_F(FirmwareUsb, AnswerThatFillsItsLastPacketEndsEmpty) {
  EXPECT_FALSE(ask(0xa1, 1, 0x0300, 64).ends_empty);
  EXPECT_TRUE(ask(0xa1, 1, 0x0300, 65).ends_empty);
  EXPECT_FALSE(ask(0x80, 6, 0x0100, 65).ends_empty);
}

TEST_F(FirmwareUsb, AddressIsGivenToTheDriverOfTheChip) {
  const UsbReply reply = ask(0, 5, 42, 0);
  EXPECT_EQ(reply.kind, UsbReply::kSetAddress);
  EXPECT_EQ(reply.address, 42);
}

TEST_F(FirmwareUsb, AnyRequestIsAnsweredWithinItsLength) {
  support::Random random(77);
  for (int i = 0; i < 200'000; ++i) {
    const auto bytes = support::any_bytes(random, 8);
    std::array<std::uint8_t, 8> packet{};
    std::memcpy(packet.data(), bytes.data(), 8);
    if (i % 2 == 0) packet[0] &= 0xa1;
    if (i % 4 == 0) packet[1] = 6;
    const UsbReply reply = device_.setup(packet.data());
    ASSERT_LE(reply.size, packet[6] | packet[7] << 8);
    ASSERT_TRUE(reply.size == 0 || reply.data != nullptr);
  }
}

}  // namespace
}  // namespace thimble::firmware::test
