#include "firmware/core/packet.h"

#include <gtest/gtest.h>

#include <string_view>

#include "messages.h"
#include "support/noise.h"

namespace thimble::firmware::test {
namespace {

TEST(FirmwareCrc, HasThePublishedCheckValue) {
  const std::string_view text = "123456789";
  EXPECT_EQ(crc16(reinterpret_cast<const std::uint8_t*>(text.data()), text.size()), 0x29b1);
}

State some_state() {
  State state;
  state.number = 0x0201;
  state.time_us = 0x06050403;
  state.counts[0] = 0x0a090807;
  state.counts[2] = -2;
  state.flags = kOverSpeed | kRestarted;
  state.stage = Stage::kFault;
  state.buttons = 5;
  state.current_mA[1] = -1000;
  state.temperature_dC = 251;
  state.supply_mV = 24000;
  state.echo = 0x1234;
  state.gimbal[2] = -3;
  state.refused = 7;
  state.loop_us = 42;
  return state;
}

TEST(FirmwarePacket, StateHasTheLayoutOfTheReadme) {
  std::array<std::uint8_t, kStateSize> bytes{};
  encode_state(some_state(), bytes.data());
  const std::array<std::uint8_t, kStateSize - 2> expected = {
      0x01, 1,    0x01, 0x02, 3,    4,    5, 6, 7,    8,    9,    10,   0,  0, 0,   0,
      0xfe, 0xff, 0xff, 0xff, 0x02, 0x01, 2, 5, 0,    0,    0x18, 0xfc, 0,  0, 251, 0,
      0xc0, 0x5d, 0x34, 0x12, 0,    0,    0, 0, 0xfd, 0xff, 7,    0,    42, 0};
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_EQ(bytes[i], expected[i]) << i;
  EXPECT_EQ(get<std::uint16_t>(bytes.data() + 46), crc16(bytes.data(), 46));
}

TEST(FirmwarePacket, DescriptionHasTheLayoutOfTheReadme) {
  ArmConfig config;
  config.motors = 2;
  config.geometry = Geometry::kFiveBar;
  config.serial[7] = 9;
  config.arm_file_hash = 0x04030201;
  config.current_max_mA = 1500;
  config.supply_min_mV = 9000;
  config.counts_per_turn[2] = 0;
  config.ratio[1] = 2.5f;
  config.board[5] = 'x';
  std::array<std::uint8_t, kDescriptionSize> bytes{};
  encode_description(config, kRestarted, bytes.data());
  const auto word = [&](std::size_t at) { return get<std::uint16_t>(bytes.data() + at); };
  EXPECT_EQ(bytes[0], 0x02);
  EXPECT_EQ(bytes[1], 1);
  EXPECT_EQ(bytes[2], 2);
  EXPECT_EQ(bytes[3], 4);
  EXPECT_EQ(bytes[11], 9);
  EXPECT_EQ(get<std::uint32_t>(bytes.data() + 12), 0x04030201u);
  EXPECT_EQ(word(16), 50);
  EXPECT_EQ(word(18), 1000);
  EXPECT_EQ(word(20), 1000);
  EXPECT_EQ(word(22), 1500);
  EXPECT_EQ(word(24), 4000);
  EXPECT_EQ(word(26), 800);
  EXPECT_EQ(word(28), 9000);
  EXPECT_EQ(word(30), 0x100);
  EXPECT_EQ(get<std::uint32_t>(bytes.data() + 36), 2000u);
  EXPECT_EQ(get<std::uint32_t>(bytes.data() + 40), 0u);
  EXPECT_EQ(get<float>(bytes.data() + 48), 2.5f);
  EXPECT_EQ(bytes[61], 'x');
  EXPECT_EQ(word(62), crc16(bytes.data(), 62));
}

TEST(FirmwarePacket, AcceptsExactLengthsAndHidReportsOnly) {
  Message bytes = drive(0.5f, -1, 2, 0x0102);
  for (std::size_t size = 0; size <= 70; ++size) {
    bytes.resize(std::max(size, bytes.size()));
    Command command;
    EXPECT_EQ(decode_command(bytes.data(), size, command), size == kDriveSize || size == 64)
        << size;
    if (size != kDriveSize) continue;
    EXPECT_EQ(command.amperes[0], 0.5f);
    EXPECT_EQ(command.amperes[2], 2.0f);
    EXPECT_EQ(command.number, 0x0102);
  }
}

TEST(FirmwarePacket, EachFlippedBitIsRefused) {
  for (const Message& good : {drive(0.5f, -1, 2), message(kClear), message(kStop),
                              message(kBlink, std::array<std::uint16_t, 1>{500})}) {
    for (std::size_t bit = 0; bit < 8 * good.size(); ++bit) {
      Message bytes = good;
      bytes[bit / 8] = static_cast<std::uint8_t>(bytes[bit / 8] ^ (1 << (bit % 8)));
      Command command;
      EXPECT_FALSE(decode_command(bytes.data(), bytes.size(), command)) << bit;
    }
  }
}

TEST(FirmwarePacket, OtherVersionsAndTypesAreRefused) {
  for (const auto& [type, version] : {std::pair{kStop, 2}, std::pair{kState, 1}}) {
    const Message bytes =
        closed({static_cast<std::uint8_t>(type), static_cast<std::uint8_t>(version), 0, 0});
    Command command;
    EXPECT_FALSE(decode_command(bytes.data(), bytes.size(), command)) << version;
  }
}

TEST(FirmwarePacket, DecodesRandomBytesWithoutHarm) {
  support::Random random(53);
  int accepted = 0;
  for (int i = 0; i < 200'000; ++i) {
    const auto bytes = support::any_bytes(random, static_cast<std::size_t>(i % 80));
    Command command;
    accepted +=
        decode_command(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), command);
  }
  EXPECT_EQ(accepted, 0);
}

}  // namespace
}  // namespace thimble::firmware::test
