#include "firmware/core/cobs.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <vector>

#include "support/noise.h"

namespace thimble::firmware::test {
namespace {

std::vector<std::vector<std::uint8_t>> read(FrameReader& reader,
                                            const std::vector<std::uint8_t>& bytes) {
  std::vector<std::vector<std::uint8_t>> found;
  for (const std::uint8_t byte : bytes) {
    const std::size_t size = reader.take(byte);
    if (size > 0) found.emplace_back(reader.content(), reader.content() + size);
  }
  return found;
}

std::vector<std::uint8_t> frame_of(const std::vector<std::uint8_t>& content) {
  std::array<std::uint8_t, kFrameMax> frame{};
  const std::size_t size = encode_frame(content.data(), content.size(), frame.data());
  return {frame.begin(), frame.begin() + static_cast<std::ptrdiff_t>(size)};
}

TEST(FirmwareCobs, EncodesTheExamplesOfThePaper) {
  EXPECT_EQ(frame_of({0}), (std::vector<std::uint8_t>{1, 1, 0}));
  EXPECT_EQ(frame_of({0x11, 0x22, 0, 0x33}),
            (std::vector<std::uint8_t>{3, 0x11, 0x22, 2, 0x33, 0}));
  EXPECT_EQ(frame_of({0x11, 0, 0, 0}), (std::vector<std::uint8_t>{2, 0x11, 1, 1, 1, 0}));
}

TEST(FirmwareCobs, ContentOfEachLengthRoundTrips) {
  support::Random random(7);
  for (std::size_t size = 1; size <= kFrameContentMax; ++size) {
    std::vector<std::uint8_t> content(size);
    for (auto& byte : content) byte = static_cast<std::uint8_t>(support::any_word(random) & 3);
    const auto frame = frame_of(content);
    EXPECT_EQ(std::count(frame.begin(), frame.end(), 0), 1);
    FrameReader reader;
    EXPECT_EQ(read(reader, frame), (std::vector<std::vector<std::uint8_t>>{content})) << size;
  }
}

TEST(FirmwareCobs, FindsTheFrameAfterTornAndOverlongOnes) {
  FrameReader reader;
  std::vector<std::uint8_t> bytes(300, 7);  // overlong
  bytes.push_back(0);
  bytes.insert(bytes.end(), {9, 1, 2, 0});  // its code byte is beyond its end
  bytes.insert(bytes.end(), {0, 0});
  const auto frame = frame_of({1, 0, 2});
  bytes.insert(bytes.end(), frame.begin(), frame.end());
  EXPECT_EQ(read(reader, bytes), (std::vector<std::vector<std::uint8_t>>{{1, 0, 2}}));
}

TEST(FirmwareCobs, RefusesContentThatIsTooLong) {
  EXPECT_TRUE(frame_of(std::vector<std::uint8_t>(kFrameContentMax + 1, 1)).empty());
}

}  // namespace
}  // namespace thimble::firmware::test
