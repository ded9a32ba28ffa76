#include "arms/falcon/falcon_packet.h"

#include <gtest/gtest.h>

#include <string_view>

#include "support/noise.h"

namespace thimble::driver::falcon {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

TEST(FalconPacket, RoundTripsInBothDirections) {
  support::Random random(51);
  for (int i = 0; i < 10'000; ++i) {
    ArmPacket arm;
    for (auto& count : arm.counts) count = support::any_word(random);
    arm.buttons = static_cast<std::uint8_t>(random.bits() & 0x0f);
    arm.homed = static_cast<std::uint8_t>(random.bits() & 0x07);
    arm.unknown_14 = static_cast<std::uint8_t>(random.bits());
    EXPECT_EQ(decode_arm_packet(encode_arm_packet(arm)), arm);
    HostPacket host;
    for (auto& motor : host.motors) motor = support::any_word(random);
    host.lights = static_cast<std::uint8_t>(random.bits());
    host.unknown_14 = static_cast<std::uint8_t>(random.bits());
    EXPECT_EQ(decode_host_packet(encode_host_packet(host)), host);
  }
}

TEST(FalconPacket, ReadsThePublishedExamples) {
  const auto null = decode_arm_packet(bytes_of("<AAAAAAAAAAAAAA>"));
  ASSERT_TRUE(null);
  EXPECT_EQ(*null, ArmPacket{});
  // libnifalcon's documentation: digits JFKP are 0xfa59, which is -1447.
  const auto packet = decode_arm_packet(bytes_of("<JFKPAAAAAAAAAA>"));
  ASSERT_TRUE(packet);
  EXPECT_EQ(packet->counts[0], -1447);
}

TEST(FalconPacket, DistinguishesButtonsAndHomedLegs) {
  auto bytes = encode_arm_packet({.counts = {}, .buttons = 0x9, .homed = 0x5, .unknown_14 = 0});
  EXPECT_EQ(std::to_integer<int>(bytes[13]), 0x41 + 0x59);
  EXPECT_EQ(decode_arm_packet(bytes)->buttons, 0x9);
  EXPECT_EQ(decode_arm_packet(bytes)->homed, 0x5);
}

TEST(FalconPacket, RejectsWrongLengthsBracketsAndDigits) {
  const auto good = encode_arm_packet({.counts = {1, -2, 3}});
  support::Random random(52);
  for (std::size_t length = 0; length <= 80; ++length) {
    auto bytes = support::any_bytes(random, length);
    if (length == kPacketSize) continue;
    if (!bytes.empty()) bytes.front() = std::byte{'<'}, bytes.back() = std::byte{'>'};
    EXPECT_FALSE(decode_arm_packet(bytes)) << length;
    EXPECT_FALSE(decode_host_packet(bytes)) << length;
  }
  for (std::size_t at = 0; at <= 12; ++at) {
    for (const int value : {0, 0x40, 0x51, 0xff}) {
      auto bytes = good;
      bytes[at] = static_cast<std::byte>(value);
      EXPECT_FALSE(decode_arm_packet(bytes)) << at << " " << value;
      EXPECT_FALSE(decode_host_packet(bytes)) << at << " " << value;
    }
  }
}

}  // namespace
}  // namespace thimble::driver::falcon
