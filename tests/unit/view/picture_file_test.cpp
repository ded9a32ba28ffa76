#include "view/gl/picture_file.h"

#include <gtest/gtest.h>
#include <zlib.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "support/random.h"
#include "support/scratch.h"
#include "view/gl/animated_picture_file.h"
#include "view/gl/colour_table.h"

namespace thimble::view {
namespace {

/// Makes a picture with gradients and a few spots, similar to a shaded scene.
Picture any_picture(support::Random& random, int width, int height) {
  Picture picture{width, height, {}};
  const double turn = random.uniform(0, 6);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const double wave = 0.5 + 0.5 * std::sin(turn + 0.03 * x + 0.05 * y);
      picture.rgb.push_back(static_cast<std::uint8_t>(200 * wave + 20));
      picture.rgb.push_back(static_cast<std::uint8_t>(180 * wave + 40));
      picture.rgb.push_back(static_cast<std::uint8_t>(random.bits() % 50 == 0 ? 250 : 90));
    }
  }
  return picture;
}

/// Returns a picture in the colours of a table.
std::vector<std::uint8_t> in_colours(const ColourTable& table,
                                     const std::vector<std::uint8_t>& numbers) {
  std::vector<std::uint8_t> rgb;
  for (const std::uint8_t number : numbers) {
    const auto& colour = table.colours().at(number);
    rgb.insert(rgb.end(), colour.begin(), colour.end());
  }
  return rgb;
}

std::size_t number_at(const std::string& bytes, std::size_t at) {
  std::size_t number = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    number = number << 8U | static_cast<unsigned char>(bytes.at(at + i));
  }
  return number;
}

/// Returns the picture after each frame of an animated PNG, as indices of colours. Fails the test
/// if a chunk is invalid.
std::vector<std::vector<std::uint8_t>> frames_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::vector<std::vector<std::uint8_t>> frames;
  std::size_t picture_width = 0, width = 0, height = 0, left = 0, top = 0, sequence = 0;
  std::vector<std::uint8_t> shown;
  for (std::size_t at = 8; at < bytes.size(); at += number_at(bytes, at) + 12) {
    const std::size_t size = number_at(bytes, at);
    const std::string name = bytes.substr(at + 4, 4);
    EXPECT_EQ(
        crc32(0, reinterpret_cast<const Bytef*>(&bytes.at(at + 4)), static_cast<uInt>(size + 4)),
        number_at(bytes, at + 8 + size));
    std::size_t data = at + 8;
    if (name == "IHDR") {
      picture_width = number_at(bytes, data);
      shown.assign(picture_width * number_at(bytes, data + 4), 0);
    }
    if (name == "fcTL" || name == "fdAT") {
      EXPECT_EQ(number_at(bytes, data), sequence++);
    }
    if (name == "fcTL") {
      width = number_at(bytes, data + 4);
      height = number_at(bytes, data + 8);
      left = number_at(bytes, data + 12);
      top = number_at(bytes, data + 16);
    }
    if (name != "IDAT" && name != "fdAT") continue;
    if (name == "fdAT") data += 4;
    std::vector<std::uint8_t> rows((width + 1) * height);
    uLongf got = rows.size();
    EXPECT_EQ(uncompress(rows.data(), &got, reinterpret_cast<const Bytef*>(&bytes.at(data)),
                         static_cast<uLong>(at + 8 + size - data)),
              Z_OK);
    EXPECT_EQ(got, rows.size());
    for (std::size_t y = 0; y < height; ++y) {
      EXPECT_EQ(rows.at(y * (width + 1)), 0);  // no filter
      for (std::size_t x = 0; x < width; ++x) {
        shown.at((top + y) * picture_width + left + x) = rows.at(y * (width + 1) + 1 + x);
      }
    }
    frames.push_back(shown);
  }
  return frames;
}

double mean_difference(const Picture& a, const Picture& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(a.rgb[i] - b.rgb[i]);
  return sum / static_cast<double>(a.rgb.size());
}

TEST(PictureFile, ReadsBackEveryByteWritten) {
  support::Random random(5);
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {131, 77}}) {
    const Picture picture = any_picture(random, width, height);
    const auto file = support::scratch_folder() / "all.png";
    ASSERT_TRUE(write_png(picture, file, PngColours::kAll));
    const auto read = read_png(file);
    ASSERT_TRUE(read);
    EXPECT_EQ(read->width, width);
    EXPECT_EQ(read->height, height);
    EXPECT_EQ(read->rgb, picture.rgb);
  }
}

TEST(PictureFile, FewColoursLookAlikeAndSaveSpace) {
  support::Random random(6);
  const Picture picture = any_picture(random, 320, 240);
  const auto all = support::scratch_folder() / "all.png";
  const auto few = support::scratch_folder() / "few.png";
  ASSERT_TRUE(write_png(picture, all, PngColours::kAll));
  ASSERT_TRUE(write_png(picture, few, PngColours::k256));
  const auto read = read_png(few);
  ASSERT_TRUE(read);
  EXPECT_LT(mean_difference(*read, picture), 2.5);
  EXPECT_LT(std::filesystem::file_size(few), std::filesystem::file_size(all));
}

TEST(PictureFile, FewColoursUseOnlyTheTable) {
  support::Random random(9);
  for (const auto& [width, height] : {std::pair{1, 1}, {3, 2}, {131, 77}}) {
    const Picture picture = any_picture(random, width, height);
    const auto file = support::scratch_folder() / "table.png";
    ASSERT_TRUE(write_png(picture, file));
    const auto read = read_png(file);
    ASSERT_TRUE(read);
    const ColourTable table({&picture});
    EXPECT_EQ(read->rgb, in_colours(table, table.numbers(picture)));
  }
}

TEST(PictureFile, AnimationShowsEachPictureWithTableColours) {
  support::Random random(10);
  std::vector<Picture> pictures;
  for (int i = 0; i < 3; ++i) pictures.push_back(any_picture(random, 31, 20));
  pictures.push_back(pictures.back());
  pictures.back().rgb[3 * (31 * 7 + 5)] ^= 0x80U;  // a change of one pixel
  const auto file = support::scratch_folder() / "frames.png";
  ASSERT_TRUE(write_animated_png(pictures, 0.04, file));
  const auto frames = frames_of(file);
  ASSERT_EQ(frames.size(), pictures.size());
  const ColourTable table({&pictures[0], &pictures[1], &pictures[2], &pictures[3]});
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_EQ(frames[i], table.numbers(pictures[i])) << "picture " << i;
  }
}

TEST(PictureFile, StillReadersShowTheFirstPicture) {
  support::Random random(7);
  std::vector<Picture> pictures;
  for (int i = 0; i < 4; ++i) pictures.push_back(any_picture(random, 90, 60));
  pictures.push_back(pictures.back());  // and one without a change
  const auto file = support::scratch_folder() / "animated.png";
  ASSERT_TRUE(write_animated_png(pictures, 0.04, file));
  const auto read = read_png(file);
  ASSERT_TRUE(read);
  EXPECT_LT(mean_difference(*read, pictures[0]), 3);
}

TEST(PictureFile, ErrorsNameTheFile) {
  support::Random random(8);
  const auto nowhere = support::scratch_folder() / "no_such_folder" / "a.png";
  const auto written = write_png(any_picture(random, 4, 4), nowhere);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("a.png"), std::string::npos);
  const auto animated = write_animated_png({any_picture(random, 4, 4)}, 0.04, nowhere);
  ASSERT_FALSE(animated);
  EXPECT_NE(animated.error().message.find("a.png"), std::string::npos);
  if (std::filesystem::is_character_file("/dev/full")) {  // a disk without space
    EXPECT_FALSE(write_png(any_picture(random, 200, 200), "/dev/full"));
    EXPECT_FALSE(write_animated_png({any_picture(random, 200, 200)}, 0.04, "/dev/full"));
    EXPECT_TRUE(std::filesystem::is_character_file("/dev/full"));  // and it was not deleted
  }
  EXPECT_FALSE(read_png(nowhere));
}

}  // namespace
}  // namespace thimble::view
