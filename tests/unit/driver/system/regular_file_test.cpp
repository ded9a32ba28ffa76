#include "system/regular_file.h"

#include <gtest/gtest.h>

#include <sys/stat.h>
#include <unistd.h>
#include <fstream>
#include <string>

#include "support/scratch.h"

namespace thimble::driver {
namespace {

namespace fs = std::filesystem;

fs::path written(const char* name, const std::string& text) {
  fs::path path = support::scratch_folder() / name;
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

TEST(ReadFile, ReturnsAllBytes) {
  const std::string text("a\0b\n", 4);
  const auto read = read_file(written("bytes", text), 100);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, text);
}

TEST(ReadFile, ReturnsNothingOfAnEmptyFile) {
  const auto read = read_file(written("empty", ""), 100);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, "");
}

TEST(ReadFile, ReadsFilesThatHideTheirSize) {
  const auto read = read_file("/proc/self/maps", 10'000'000);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_GT(read->size(), 100U);
}

TEST(ReadFile, RefusesAFileAboveTheLimit) {
  const auto path = written("large", std::string(1000, 'x'));
  EXPECT_TRUE(read_file(path, 1000));
  const auto read = read_file(path, 999);
  ASSERT_FALSE(read);
  EXPECT_EQ(read.error().message, "it is larger than 0.999 kB, the limit for this kind of file.");
}

TEST(ReadFile, RefusesAFileOfHiddenSizeAboveTheLimit) {
  EXPECT_FALSE(read_file("/proc/self/maps", 100));
}

TEST(ReadFile, RefusesAnEndlessDevice) {
  const auto read = read_file("/dev/zero", 100);
  ASSERT_FALSE(read);
  EXPECT_NE(read.error().message.find("not a regular file"), std::string::npos);
}

// Opening a pipe without a writer must not block.
TEST(ReadFile, RefusesAPipe) {
  const auto path = support::scratch_folder() / "pipe";
  ASSERT_EQ(mkfifo(path.c_str(), 0600), 0);
  EXPECT_FALSE(read_file(path, 100));
  EXPECT_EQ(read_head(path, 4), "");
  EXPECT_FALSE(is_regular(path));
}

TEST(ReadFile, RefusesAFolder) {
  EXPECT_FALSE(read_file(support::scratch_folder(), 100));
}

TEST(ReadFile, FollowsALinkToARegularFile) {
  const auto link = support::scratch_folder() / "link";
  fs::create_symlink(written("target", "text"), link);
  const auto read = read_file(link, 100);
  ASSERT_TRUE(read) << read.error().message;
  EXPECT_EQ(*read, "text");
}

TEST(ReadFile, RefusesALinkToADevice) {
  const auto link = support::scratch_folder() / "link_to_device";
  fs::create_symlink("/dev/zero", link);
  EXPECT_FALSE(read_file(link, 100));
}

TEST(ReadHead, ReturnsTheFirstBytes) {
  const auto path = written("head", "magic and more");
  EXPECT_EQ(read_head(path, 5), "magic");
  EXPECT_EQ(read_head(path, 100), "magic and more");
}

TEST(RegularFile, CountsHolesAsNotStored) {
  const auto path = written("sparse", "begin");
  fs::resize_file(path, 100'000'000);
  const auto file = RegularFile::open(path);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->size(), 100'000'000U);
  EXPECT_LT(file->stored(), 10'000'000U);
  EXPECT_GE(file->stored(), 5U);
}

}  // namespace
}  // namespace thimble::driver
