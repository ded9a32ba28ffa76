#include "disk_paging/frame_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "disk_paging/checksum.h"
#include "disk_paging/page_file.h"
#include "support/random.h"

namespace thimble::render {
namespace {

TEST(FrameOrder, OldestIsTheFrameNotUsedForTheLongestTime) {
  support::Random random(300);
  for (const std::size_t frames : {1u, 2u, 7u}) {
    FrameOrder order(frames);
    std::vector<std::int32_t> expected;  // the oldest first
    for (std::size_t i = 0; i < frames; ++i) expected.push_back(static_cast<std::int32_t>(i));
    for (int step = 0; step < 100; ++step) {
      ASSERT_EQ(order.oldest(), expected.front()) << step;
      const auto frame = static_cast<std::int32_t>(random.bits() % frames);
      order.use(frame);
      expected.erase(std::find(expected.begin(), expected.end(), frame));
      expected.push_back(frame);
    }
  }
}

// The definition of the checksum of page files, one word after the other.
std::uint64_t checksum_by_word(std::span<const std::byte> bytes, std::uint64_t seed) {
  constexpr std::uint64_t kFactor = 0x9e3779b97f4a7c15u;
  std::array<std::uint64_t, 4> sums{seed + 1, seed + 2, seed + 3, seed + 4};
  for (std::size_t at = 0; at < bytes.size(); at += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes.data() + at, std::min<std::size_t>(8, bytes.size() - at));
    std::uint64_t& sum = sums[at / 8 % 4];
    sum = std::rotl((sum ^ word) * kFactor, 29);
  }
  std::uint64_t whole = bytes.size();
  for (const std::uint64_t sum : sums) whole = std::rotl((whole ^ sum) * kFactor, 29);
  return whole;
}

TEST(Checksum, OfEveryLengthFollowsItsDefinition) {
  support::Random random(301);
  std::array<std::byte, 200> bytes;
  for (std::byte& byte : bytes) byte = static_cast<std::byte>(random.bits());
  for (std::size_t size = 0; size <= bytes.size(); ++size) {
    const auto part = std::span(bytes).first(size);
    EXPECT_EQ(checksum(part, size), checksum_by_word(part, size)) << size;
  }
}

TEST(PageBox, IsTheBoxOfAllCornersRoundedOutwards) {
  support::Random random(302);
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  for (int k = 0; k < 200; ++k) {
    std::vector<PackedTriangle> triangles(1 + random.bits() % 17);
    std::array<float, 3> min{kInfinity, kInfinity, kInfinity};
    std::array<float, 3> max{-kInfinity, -kInfinity, -kInfinity};
    for (PackedTriangle& packed : triangles) {
      std::size_t axis = 0;
      for (auto* const corners : {&packed.x, &packed.y, &packed.z}) {
        for (std::int32_t& corner : *corners) {
          corner = static_cast<std::int32_t>(random.bits());
          const auto nearest = static_cast<float>(corner);
          min[axis] = std::min(min[axis], std::nextafter(nearest, -kInfinity));
          max[axis] = std::max(max[axis], std::nextafter(nearest, kInfinity));
        }
        ++axis;
      }
    }
    const PageBox box = box_of(triangles);
    EXPECT_EQ(box.min, min) << k;
    EXPECT_EQ(box.max, max) << k;
  }
}

}  // namespace
}  // namespace thimble::render
