#include <gtest/gtest.h>

#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <utility>

#include "disk_paging/checksum.h"
#include "disk_paging/page_file.h"
#include "support/meshes/shapes.h"
#include "support/scratch.h"

// Damaged boxes of a page file with a valid checksum.

namespace thimble::render {
namespace {

std::filesystem::path written(const char* name, const std::string& bytes) {
  const auto path = support::scratch_folder() / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

/// Returns the bytes of a page file of 5,120 triangles: 5 pages.
std::string good_file() {
  const auto path = support::scratch_folder() / "boxes.pages";
  const auto surface = PackedSurface::build(support::icosphere(4, 0.05)).value();
  EXPECT_TRUE(write_page_file(surface, path).ok());
  std::ifstream stream(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

std::size_t pages_of(const std::string& bytes) {
  return PageFile::open(written("counted.pages", bytes))->boxes().size();
}

/// Opens a file of these bytes and returns the error.
std::string refusal(const std::string& bytes) {
  const auto opened = PageFile::open(written("damaged_boxes.pages", bytes));
  return opened ? "" : opened.error().message;
}

/// Recomputes the checksum of everything before the pages.
void put_sum_right(std::string& bytes, std::size_t pages) {
  constexpr std::size_t kSum = 20, kHeader = 72;
  std::memset(bytes.data() + kSum, 0, 4);
  const auto part = [&bytes](std::size_t begin, std::size_t size) {
    return std::as_bytes(std::span(bytes.data() + begin, size));
  };
  std::uint64_t sum = checksum(part(0, kHeader));
  sum = checksum(part(kHeader, 24 * pages), sum);
  sum = checksum(part(kHeader + 24 * pages, 8 * pages), sum);
  const auto folded = static_cast<std::uint32_t>(sum ^ (sum >> 32));
  std::memcpy(bytes.data() + kSum, &folded, 4);
}

TEST(PageFile, IsRefusedWithImpossibleBoxes) {
  const std::string good = good_file();
  const std::size_t pages = pages_of(good);
  std::string same = good;
  put_sum_right(same, pages);
  EXPECT_EQ(refusal(same), "");
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::size_t low = 72 + 24 * 3 + 4 * axis, high = low + 12;
    for (const auto& [at, value] : {std::pair{low, 4e9F},
                                    {high, -4e9F},
                                    {low, -1e10F},
                                    {high, 1e10F},
                                    {low, std::numeric_limits<float>::quiet_NaN()},
                                    {high, std::numeric_limits<float>::infinity()}}) {
      std::string wrong = good;
      std::memcpy(wrong.data() + at, &value, 4);
      put_sum_right(wrong, pages);
      EXPECT_NE(refusal(wrong).find("its boxes are damaged"), std::string::npos)
          << at << ' ' << value;
    }
  }
}

}  // namespace
}  // namespace thimble::render
