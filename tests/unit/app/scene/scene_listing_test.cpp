// Only regular files are listed and read, so that a pipe cannot block the program.

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

class SceneListing : public testing::Test {
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

  fs::path folder_;
};

TEST_F(SceneListing, PipeAmongScenesIsNotListed) {
  fs::create_directories(folder_ / "thimble" / "scenes");
  const fs::path pipe = folder_ / "thimble" / "scenes" / "pipe.yaml";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  ASSERT_EQ(setenv("XDG_DATA_DIRS", folder_.c_str(), 1), 0);
  for (const ShippedFile& scene : shipped_scenes()) EXPECT_NE(scene.path, pipe);
  EXPECT_EQ(description_of(pipe), "");
  unsetenv("XDG_DATA_DIRS");
}

TEST_F(SceneListing, DescriptionOfLatin1IsEmpty) {
  EXPECT_EQ(description_of(write("a.yaml", "description: caf\xe9\n")), "");
  EXPECT_EQ(description_of(write("b.yaml", "description: caf\xc3\xa9\n")), "caf\xc3\xa9");
}

}  // namespace
}  // namespace thimble::scene
