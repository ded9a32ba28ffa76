#include "view/gl/picture_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "support/random.h"
#include "support/scratch.h"

namespace thimble::app::view {
namespace {

/// Makes a picture with slopes and a few spots, as a shaded scene has.
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

TEST(PictureFile, FewColoursAreHardlySeenAndTakeLessRoom) {
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

TEST(PictureFile, AnimationShowsItsFirstPictureToReadersThatKnowNone) {
  support::Random random(7);
  std::vector<Picture> pictures;
  for (int i = 0; i < 4; ++i) pictures.push_back(any_picture(random, 90, 60));
  pictures.push_back(pictures.back());  // and one in which nothing changes
  const auto file = support::scratch_folder() / "animated.png";
  ASSERT_TRUE(write_animated_png(pictures, 0.04, file));
  const auto read = read_png(file);
  ASSERT_TRUE(read);
  EXPECT_LT(mean_difference(*read, pictures[0]), 3);
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  std::size_t frames = 0;
  for (std::size_t at = bytes.find("fcTL"); at != std::string::npos;
       at = bytes.find("fcTL", at + 1)) {
    ++frames;
  }
  EXPECT_EQ(frames, pictures.size());
}

TEST(PictureFile, TellsWhereNothingCanBeWrittenOrRead) {
  support::Random random(8);
  const auto nowhere = support::scratch_folder() / "no_such_folder" / "a.png";
  const auto written = write_png(any_picture(random, 4, 4), nowhere);
  ASSERT_FALSE(written);
  EXPECT_NE(written.error().message.find("a.png"), std::string::npos);
  EXPECT_FALSE(read_png(nowhere));
}

}  // namespace
}  // namespace thimble::app::view
