#include "transports/frame_finder.h"

#include <gtest/gtest.h>

#include <string>
#include <string_view>
#include <vector>

#include "arms/falcon/falcon_packet.h"
#include "support/noise.h"
#include "transports/ftdi_packet.h"

namespace thimble::driver {
namespace {

constexpr Framing kSquare{.begin = std::byte{'['}, .end = std::byte{']'}, .size_max = 20};

void push(FrameFinder& finder, std::string_view text) {
  finder.push({reinterpret_cast<const std::byte*>(text.data()), text.size()});
}

std::string take(FrameFinder& finder, std::uint32_t* skipped = nullptr) {
  std::array<std::byte, kReportCapacity> buffer{};
  std::uint32_t ignored = 0;
  const std::size_t size = finder.take(buffer, skipped != nullptr ? *skipped : ignored);
  return {reinterpret_cast<const char*>(buffer.data()), size};
}

TEST(FrameFinder, FindsMessagesInPiecesOfAnySize) {
  const std::string stream = "\r\n[1,2,3]\n[4,5]junk[6]";
  for (std::size_t piece = 1; piece <= stream.size(); ++piece) {
    FrameFinder finder(kSquare);
    std::vector<std::string> found;
    for (std::size_t at = 0; at < stream.size(); at += piece) {
      push(finder, std::string_view(stream).substr(at, piece));
      if (finder.ready()) found.push_back(take(finder));
    }
    EXPECT_EQ(found.back(), "[6]") << piece;
    if (piece == 1) {
      EXPECT_EQ(found, (std::vector<std::string>{"[1,2,3]", "[4,5]", "[6]"}));
    }
    EXPECT_EQ(finder.torn(), 0u);
  }
}

TEST(FrameFinder, KeepsTheNewestMessageAndCountsTheOthers) {
  FrameFinder finder(kSquare);
  push(finder, "[1][2][3]");
  std::uint32_t skipped = 0;
  EXPECT_EQ(take(finder, &skipped), "[3]");
  EXPECT_EQ(skipped, 2u);
  EXPECT_FALSE(finder.ready());
  EXPECT_EQ(take(finder), "");
}

TEST(FrameFinder, DropsAndCountsTornAndOverlongMessages) {
  FrameFinder finder(kSquare);
  push(finder, "[1,2[3,4]");
  EXPECT_EQ(take(finder), "[3,4]");
  EXPECT_EQ(finder.torn(), 1u);
  push(finder, "[" + std::string(50, '1') + "][5]");
  EXPECT_EQ(take(finder), "[5]");
  EXPECT_EQ(finder.torn(), 2u);
}

TEST(FrameFinder, ReturnsOnlyFramedMessagesThatFit) {
  support::Random random(81);
  FrameFinder finder({.begin = std::byte{'<'}, .end = std::byte{'>'}, .size_max = 16});
  std::array<std::byte, kReportCapacity> buffer{};
  std::uint64_t found = 0;
  for (int i = 0; i < 50'000; ++i) {
    const auto packet = falcon::encode_arm_packet({.counts = {support::any_word(random)}});
    finder.push(support::damaged(random, {packet.begin(), packet.end()}));
    std::uint32_t skipped = 0;
    const std::size_t size = finder.take(buffer, skipped);
    if (size == 0) continue;
    ++found;
    ASSERT_LE(size, 16u);
    EXPECT_EQ(buffer[0], std::byte{'<'});
    EXPECT_EQ(buffer[size - 1], std::byte{'>'});
  }
  EXPECT_GT(found, 1000u);
}

TEST(FtdiPacket, OnlyTheTwoStatusBytesAreRemoved) {
  support::Random random(82);
  for (std::size_t size = 0; size <= 300; ++size) {
    const auto content = support::any_bytes(random, size);
    std::vector<std::byte> transfer;
    for (std::size_t at = 0; at < size; at += 62) {
      transfer.push_back(std::byte{0x01});
      transfer.push_back(std::byte{0x60});
      const std::size_t end = std::min(size, at + 62);
      transfer.insert(transfer.end(), content.begin() + static_cast<std::ptrdiff_t>(at),
                      content.begin() + static_cast<std::ptrdiff_t>(end));
    }
    std::vector<std::byte> heard;
    for_each_ftdi_packet(transfer, [&](std::span<const std::byte> part) {
      heard.insert(heard.end(), part.begin(), part.end());
    });
    EXPECT_EQ(heard, content) << size;
  }
}

TEST(FtdiPacket, HoldsNothingIfItIsTooShortForItsStatus) {
  for (const std::size_t size : {0U, 1U, 2U, 64U + 1, 64U + 2}) {
    std::size_t heard = 0;
    for_each_ftdi_packet(std::vector<std::byte>(size),
                         [&](std::span<const std::byte> part) { heard += part.size(); });
    EXPECT_EQ(heard, size > 60 ? 62u : 0u) << size;
  }
}

}  // namespace
}  // namespace thimble::driver
