#include "arms/hfab/hfab_line.h"

#include <gtest/gtest.h>

#include <climits>
#include <cstring>
#include <string_view>

#include "arms/hfab/hfab_wire.h"
#include "support/noise.h"

namespace thimble::driver::hfab {
namespace {

std::span<const std::byte> bytes_of(std::string_view text) {
  return {reinterpret_cast<const std::byte*>(text.data()), text.size()};
}

std::int32_t any_number(support::Random& random) {
  // Numbers of every length; uniform ones would almost always have ten digits.
  return static_cast<std::int32_t>(static_cast<std::int64_t>(random.bits()) >>
                                   (32 + random.bits() % 32));
}

TEST(HfabLine, RoundTripsInBothDirections) {
  support::Random random(41);
  std::array<std::byte, kLineCapacity> buffer{};
  for (int i = 0; i < 10'000; ++i) {
    ArmLine arm{.model = any_number(random), .counts = {}, .error = any_number(random)};
    for (auto& count : arm.counts) count = any_number(random);
    std::size_t size = encode_arm_line(arm, buffer);
    EXPECT_EQ(decode_arm_line(std::span(buffer).first(size)), arm);
    HostLine host;
    for (auto& current : host.current_mA) current = any_number(random);
    size = encode_host_line(host, buffer);
    EXPECT_EQ(decode_host_line(std::span(buffer).first(size)), host);
  }
}

TEST(HfabLine, HasRoomForTheLongestNumbers) {
  std::array<std::byte, kLineCapacity> buffer{};
  ArmLine line{.model = INT_MIN, .counts = {}, .error = INT_MIN};
  line.counts.fill(INT_MIN);
  EXPECT_EQ(encode_arm_line(line, buffer), kLineCapacity);
  EXPECT_EQ(decode_arm_line(buffer), line);
}

TEST(HfabLine, MatchesThePublishedProtocol) {
  std::array<std::byte, kLineCapacity> buffer{};
  const std::size_t size = encode_host_line({.current_mA = {12, -345, 6000}}, buffer);
  EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(buffer.data()), size),
            "[12,-345,6000]\n");
  const auto line = decode_arm_line(bytes_of("[3,1,-2,3,4,-5,6,1024]\r\n"));
  ASSERT_TRUE(line);
  EXPECT_EQ(line->model, 3);
  EXPECT_EQ(line->counts, (std::array<std::int32_t, 6>{1, -2, 3, 4, -5, 6}));
  EXPECT_EQ(line->error, kErrorParse);
}

TEST(HfabLine, RejectsTornAndMalformedLines) {
  for (const char* text :
       {"", "[", "]", "[]", "[1,2,3", "1,2,3]", "[1,2]", "[1,2,3,4]", "[1,,3]", "[1,2,3]x",
        "[1, 2,3]", "[+1,2,3]", "[1,2,3.5]", "[0x1,2,3]", "[2147483648,0,0]", "[1,2,3][1,2,3]",
        "[-,2,3]", " [1,2,3]", "[1;2;3]"}) {
    EXPECT_FALSE(decode_host_line(bytes_of(text))) << text;
  }
  EXPECT_TRUE(decode_host_line(bytes_of("[1,2,3]")));
  // A line of the published host library, padded with zeros to 16 bytes.
  EXPECT_TRUE(decode_host_line(bytes_of(std::string_view("[0,0,0]\n\0\0\0\0\0\0\0\0", 16))));
}

TEST(HfabLine, RejectsEveryPrefixOfALine) {
  const std::string_view whole = "[3,1,-2,3,4,-5,6,1024]";
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_FALSE(decode_arm_line(bytes_of(whole.substr(0, size)))) << size;
  }
}

TEST(LineWire, PutsEachMotorInItsPlace) {
  std::array<std::byte, kReportCapacity> buffer{};
  const std::size_t size = LineWire::encode({101, -202, 303}, buffer);
  EXPECT_EQ(std::string_view(reinterpret_cast<const char*>(buffer.data()), size),
            "[101,-202,303]\n");
  ArmReading reading;
  ASSERT_TRUE(LineWire::decode(bytes_of("[3,1,-2,3,4,-5,6,0]"), reading));
  EXPECT_EQ(reading.counts, (std::array<std::int32_t, 3>{1, -2, 3}));
  EXPECT_EQ(reading.auxiliary, (std::array<std::int32_t, 3>{4, -5, 6}));
}

}  // namespace
}  // namespace thimble::driver::hfab
