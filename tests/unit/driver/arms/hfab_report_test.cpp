#include "arms/hfab/hfab_report.h"

#include <gtest/gtest.h>

#include <vector>

#include "arms/hfab/hfab_wire.h"
#include "support/random.h"

namespace thimble::driver::hfab {
namespace {

std::int16_t any_int16(support::Random& random) {
  return static_cast<std::int16_t>(static_cast<std::uint16_t>(random.bits() >> 48));
}

TEST(HfabReport, RoundTripsInBothDirections) {
  support::Random random(1);
  for (int i = 0; i < 10'000; ++i) {
    InputReport input;
    for (auto& count : input.counts) count = any_int16(random);
    input.info = any_int16(random);
    EXPECT_EQ(decode_input(encode_input(input)), input);

    OutputReport output;
    for (auto& current : output.current_mA) current = any_int16(random);
    output.command = any_int16(random);
    for (auto& attribute : output.attributes) attribute = any_int16(random);
    EXPECT_EQ(decode_output(encode_output(output)), output);
  }
}

TEST(HfabReport, IsLittleEndianInTheOrderOfThePublishedFirmware) {
  const auto bytes = encode_output(
      {.current_mA = {0x0102, -2, 0x7fff}, .command = 1, .attributes = {0x1122, 0, -32768}});
  const std::array<int, 14> expected = {0x02, 0x01, 0xfe, 0xff, 0xff, 0x7f, 0x01,
                                        0x00, 0x22, 0x11, 0x00, 0x00, 0x00, 0x80};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_EQ(std::to_integer<int>(bytes[i]), expected[i]) << "byte " << i;
  }
}

TEST(HfabReport, AcceptsOnly14And64Bytes) {
  support::Random random(2);
  for (std::size_t length = 0; length <= 130; ++length) {
    std::vector<std::byte> bytes(length);
    for (auto& byte : bytes) byte = static_cast<std::byte>(random.bits() & 0xff);
    const bool known = length == 14 || length == 64;
    EXPECT_EQ(decode_input(bytes).has_value(), known) << length;
    EXPECT_EQ(decode_output(bytes).has_value(), known) << length;
  }
}

TEST(HfabReport, AnyBytesOfTheRightLengthRoundTrip) {
  support::Random random(3);
  for (int i = 0; i < 100'000; ++i) {
    std::array<std::byte, kReportSize> bytes;
    for (auto& byte : bytes) byte = static_cast<std::byte>(random.bits() & 0xff);
    EXPECT_EQ(encode_input(*decode_input(bytes)), bytes);
    EXPECT_EQ(encode_output(*decode_output(bytes)), bytes);
  }
}

TEST(HfabReport, ButtonIsTheLowestBitOfTheInformation) {
  for (const int info : {0, 1, 2, 3, 0x7ffe, -1}) {
    ArmReading reading;
    ASSERT_TRUE(
        ReportWire::decode(encode_input({.info = static_cast<std::int16_t>(info)}), reading));
    EXPECT_EQ(reading.buttons, info & 1) << info;
  }
}

}  // namespace
}  // namespace thimble::driver::hfab
