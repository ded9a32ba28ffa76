// Messages of described wires in a stream of bytes.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "support/noise.h"
#include "support/random.h"
#include "transports/frame_finder.h"
#include "wires/wire_table.h"

namespace thimble::driver {
namespace {

WireMark mark_of(const std::string& text) {
  WireMark mark;
  for (const char c : text) mark.bytes[mark.size++] = static_cast<std::byte>(c);
  return mark;
}

/// Pushes a text and returns the newest message, or "" if there is none.
std::string push(FrameFinder& finder, const std::string& text) {
  finder.push(std::as_bytes(std::span(text)));
  std::array<std::byte, kReportCapacity> buffer{};
  std::uint32_t skipped = 0;
  const std::size_t size = finder.take(buffer, skipped);
  return {reinterpret_cast<const char*>(buffer.data()), size};
}

WireLayout lines() {
  WireLayout layout;
  layout.framing = WireFraming::kText;
  layout.end = mark_of("\r\n");
  layout.ignore = mark_of("DBG:");
  return layout;
}

WireLayout blocks() {
  WireLayout layout;
  layout.framing = WireFraming::kHeader;
  layout.begin = mark_of("ab");
  layout.size = layout.padded = 6;
  layout.check_bytes = 1;
  layout.check_at = 5;
  layout.checksum = WireChecksum({.kind = WireCheck::kXor8});
  return layout;
}

std::string block(const std::string& body) {
  std::string text = "ab" + body;
  char check = 0;
  for (const char c : text) check = static_cast<char>(check ^ c);
  return text + check;
}

TEST(DescribedFrames, PartOfTheFirstLineIsNotUsed) {
  const WireLayout layout = lines();
  FrameFinder finder({.described = &layout});
  EXPECT_EQ(push(finder, "34,5\r\n"), "");
  EXPECT_EQ(push(finder, "1234,5\r\n"), "1234,5\r\n");
}

TEST(DescribedFrames, LinesToIgnoreAreNoMessages) {
  const WireLayout layout = lines();
  FrameFinder finder({.described = &layout});
  push(finder, "\r\n");
  EXPECT_EQ(push(finder, "DBG:hello\r\n"), "");
  EXPECT_EQ(push(finder, "1,2\r\nDBG:hello\r\n"), "1,2\r\n");
}

TEST(DescribedFrames, HeaderIsFoundBehindAFalseOne) {
  const WireLayout layout = blocks();
  FrameFinder finder({.described = &layout});
  // The first "ab" is data; the message behind it begins within its six bytes.
  EXPECT_EQ(push(finder, "xab" + block("123")), block("123"));
  EXPECT_EQ(push(finder, "aab" + block("456")), block("456"));
}

TEST(DescribedFrames, EveryUndamagedBlockIsFoundAmongDamagedOnes) {
  const WireLayout layout = blocks();
  support::Random random(57);
  FrameFinder finder({.described = &layout});
  for (int i = 0; i < 20'000; ++i) {
    const std::string good = block("12" + std::to_string(i % 10));
    const auto bytes = std::as_bytes(std::span(good));
    // Damage by noise without the first byte of a header, so that no false message can begin in it.
    auto noise = support::any_bytes(random, random.bits() % 9);
    for (std::byte& byte : noise) {
      if (byte == std::byte{'a'}) byte = std::byte{'x'};
    }
    finder.push(noise);
    finder.push(bytes);
    std::array<std::byte, kReportCapacity> buffer{};
    std::uint32_t skipped = 0;
    ASSERT_EQ(finder.take(buffer, skipped), good.size()) << i;
    EXPECT_TRUE(std::equal(bytes.begin(), bytes.end(), buffer.begin()));
  }
}

TEST(DescribedFrames, FixedMessageRestartsWithEachRequest) {
  WireLayout layout;
  layout.framing = WireFraming::kFixed;
  layout.size = layout.padded = 3;
  FrameFinder finder({.described = &layout});
  EXPECT_EQ(push(finder, "12"), "");
  finder.forget_partial();
  EXPECT_EQ(finder.torn(), 1u);
  EXPECT_EQ(push(finder, "456"), "456");
}

TEST(DescribedFrames, CobsMessagesEndWithZero) {
  WireLayout layout;
  layout.framing = WireFraming::kCobs;
  FrameFinder finder({.described = &layout});
  using namespace std::string_literals;
  EXPECT_EQ(push(finder, "tail\0"s), "");  // may have lost its beginning
  EXPECT_EQ(push(finder, "\0one\0"s), "one\0"s);
}

TEST(DescribedFrames, AnyBytesArePutInOrRefused) {
  const WireLayout layouts[] = {lines(), blocks()};
  support::Random random(58);
  for (const WireLayout& layout : layouts) {
    FrameFinder finder({.described = &layout});
    for (int i = 0; i < 20'000; ++i) {
      finder.push(support::any_bytes(random, random.bits() % 300));
      std::array<std::byte, kReportCapacity> buffer{};
      std::uint32_t skipped = 0;
      EXPECT_LE(finder.take(buffer, skipped), buffer.size());
    }
  }
}

}  // namespace
}  // namespace thimble::driver
