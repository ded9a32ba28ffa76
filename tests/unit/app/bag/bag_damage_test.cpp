#include <gtest/gtest.h>

#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "bag/read_bag.h"
#include "support/bag_maker.h"
#include "support/scratch.h"

namespace thimble::bag {
namespace {

namespace fs = std::filesystem;

/// Reads a damaged bag and checks the guarantees that hold for every result. Returns whether it was
/// accepted.
bool read_damaged(const fs::path& file, const std::vector<char>& bytes) {
  std::ofstream(file, std::ios::binary | std::ios::trunc)
      .write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  const auto read = read_bag(file, BagKind::kPositions);
  if (!read) {
    EXPECT_GT(read.error().message.size(), 20U);
    EXPECT_EQ(read.error().message.back(), '.') << read.error().message;
    return false;
  }
  EXPECT_FALSE(read->samples.empty());
  for (std::size_t i = 0; i < read->samples.size(); ++i) {
    EXPECT_TRUE(read->samples[i].value.allFinite());
    if (i > 0) {
      EXPECT_GT(read->samples[i].time, read->samples[i - 1].time);
    }
  }
  return true;
}

TEST(BagDamage, AnyDamagedByteCausesAnErrorAtMost) {
  const fs::path folder = support::scratch_folder() / "thimble_bag_damage";
  fs::create_directories(folder);
  const fs::path file = folder / "small.db3";
  {
    test::BagMaker maker(file);
    maker.topic(1, "/pose", "geometry_msgs/msg/PoseStamped");
    for (int i = 0; i < 3; ++i) {
      maker.message(1, 10 * i, encode(BagKind::kPositions, {1 + i, "world", {0.01 * i, 0, 0}}));
    }
  }
  std::vector<char> whole;
  {
    std::ifstream stream(file, std::ios::binary);
    whole.assign(std::istreambuf_iterator<char>(stream), {});
  }
  ASSERT_GT(whole.size(), 1000U);
  EXPECT_TRUE(read_damaged(file, whole));
  std::size_t taken = 0, refused = 0;
  for (std::size_t i = 0; i < whole.size(); ++i) {
    for (const int flipped : {0x80, 0xFF}) {
      std::vector<char> bytes = whole;
      bytes[i] = static_cast<char>(bytes[i] ^ flipped);
      ++(read_damaged(file, bytes) ? taken : refused);
    }
  }
  for (std::size_t length = 0; length < whole.size(); length += 7) {
    read_damaged(file, {whole.begin(), whole.begin() + static_cast<std::ptrdiff_t>(length)});
  }
  // Damage in unused bytes has no effect; damage in the tables is an error.
  EXPECT_GT(taken, 100U);
  EXPECT_GT(refused, 100U);
  fs::remove_all(folder);
}

}  // namespace
}  // namespace thimble::bag
