// Files of which only regular ones are read, so that no pipe keeps the program waiting.
#include "files/regular_file.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

#include "thimble/scene/shipped_files.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

class RegularFile : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = (fs::temp_directory_path() / "thimble_file_XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
  }
  void TearDown() override { fs::remove_all(folder_); }

  fs::path write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name, std::ios::binary) << text;
    return folder_ / name;
  }
  static std::string refusal(const fs::path& file) {
    const auto text = read_regular_file(file, 100, "a scene");
    return text ? "" : text.error().message;
  }

  fs::path folder_;
};

TEST_F(RegularFile, IsReadWhole) {
  const std::string bytes("a\0\xff\r\n", 5);
  const auto text = read_regular_file(write("a", bytes), 5, "a scene");
  ASSERT_TRUE(text.ok());
  EXPECT_EQ(*text, bytes);
}

TEST_F(RegularFile, PipeIsRefusedAtOnce) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refusal(pipe), pipe.string() + ": this is not a file; give the path of a scene.");
}

TEST_F(RegularFile, FolderAndDeviceAreRefused) {
  EXPECT_EQ(refusal(folder_), folder_.string() + ": this is not a file; give the path of a scene.");
  EXPECT_EQ(refusal("/dev/zero"), "/dev/zero: this is not a file; give the path of a scene.");
}

TEST_F(RegularFile, LinkToADeviceIsRefused) {
  fs::create_symlink("/dev/zero", folder_ / "link");
  EXPECT_NE(refusal(folder_ / "link").find("this is not a file"), std::string::npos);
}

TEST_F(RegularFile, LargerThanItsBoundIsRefused) {
  EXPECT_NE(refusal(write("a", std::string(101, 'a'))).find("is larger than"), std::string::npos);
}

TEST_F(RegularFile, EndlessFileOfTheKernelIsBounded) {
  // Of size zero by its status, and longer than 100 bytes.
  EXPECT_NE(refusal("/proc/self/status").find("is larger than"), std::string::npos);
}

TEST_F(RegularFile, AbsentFileIsNamed) {
  EXPECT_EQ(refusal(folder_ / "none"), (folder_ / "none").string() + ": there is no such file.");
}

TEST_F(RegularFile, PipeAmongScenesIsNotListed) {
  fs::create_directories(folder_ / "thimble" / "scenes");
  const fs::path pipe = folder_ / "thimble" / "scenes" / "pipe.yaml";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  ASSERT_EQ(setenv("XDG_DATA_DIRS", folder_.c_str(), 1), 0);
  for (const ShippedFile& scene : shipped_scenes()) EXPECT_NE(scene.path, pipe);
  EXPECT_EQ(description_of(pipe), "");
  unsetenv("XDG_DATA_DIRS");
}

TEST_F(RegularFile, DescriptionOfLatin1IsEmpty) {
  EXPECT_EQ(description_of(write("a.yaml", "description: caf\xe9\n")), "");
  EXPECT_EQ(description_of(write("b.yaml", "description: caf\xc3\xa9\n")), "caf\xc3\xa9");
}

}  // namespace
}  // namespace thimble::scene
