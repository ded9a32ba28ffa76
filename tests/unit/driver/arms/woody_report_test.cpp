#include "arms/woody/woody_report.h"

#include <gtest/gtest.h>

#include "arms/woody/woody_wire.h"
#include "support/noise.h"

namespace thimble::driver::woody {
namespace {

TEST(WoodyReport, RoundTripsInBothDirections) {
  support::Random random(31);
  for (int i = 0; i < 10'000; ++i) {
    InputReport input;
    for (auto& count : input.counts) count = support::any_word(random);
    input.counter = static_cast<std::uint16_t>(support::any_word(random));
    EXPECT_EQ(decode_input(encode_input(input)), input);
    OutputReport output;
    for (auto& current : output.current_mA) current = support::any_word(random);
    output.unknown_debug = static_cast<std::uint16_t>(support::any_word(random));
    EXPECT_EQ(decode_output(encode_output(output)), output);
  }
}

TEST(WoodyReport, IsLittleEndianInTheOrderOfThePublishedFirmware) {
  const auto bytes = encode_output({.current_mA = {0x0102, -2, 0x7fff}, .unknown_debug = 0xabcd});
  const std::array<int, 8> expected = {0x02, 0x01, 0xfe, 0xff, 0xff, 0x7f, 0xcd, 0xab};
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    EXPECT_EQ(std::to_integer<int>(bytes[i]), expected[i]) << "byte " << i;
  }
}

TEST(WoodyReport, AcceptsOnly8Bytes) {
  support::Random random(32);
  for (std::size_t length = 0; length <= 130; ++length) {
    const auto bytes = support::any_bytes(random, length);
    EXPECT_EQ(decode_input(bytes).has_value(), length == 8) << length;
    EXPECT_EQ(decode_output(bytes).has_value(), length == 8) << length;
  }
}

TEST(WoodyWire, ReadsCountsAndNumberOnly) {
  const auto bytes = encode_input({.counts = {11, -12, 13}, .counter = 14});
  ArmReading reading;
  reading.auxiliary = {7, 8, 9};
  reading.buttons = 3;
  ASSERT_TRUE(ReportWire::decode(bytes, reading));
  EXPECT_EQ(reading.counts, (std::array<std::int32_t, 3>{11, -12, 13}));
  EXPECT_EQ(reading.auxiliary, (std::array<std::int32_t, 3>{14, 0, 0}));
  EXPECT_EQ(reading.buttons, 0);
  EXPECT_EQ(reading.number, 14);
}

}  // namespace
}  // namespace thimble::driver::woody
