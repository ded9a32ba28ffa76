#include "view/start/recent_files.h"

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <fstream>
#include <sstream>
#include <string>

#include "support/scratch.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

fs::path list_named(const std::string& name) {
  const fs::path folder = support::scratch_folder() / ("recent_" + name);
  fs::remove_all(folder);
  return folder / "state" / "recent_scenes";
}

fs::path with_text(const std::string& name, const std::string& text) {
  const fs::path file = list_named(name);
  fs::create_directories(file.parent_path());
  std::ofstream(file) << text;
  return file;
}

TEST(RecentFiles, AreEmptyWithoutAFileAndWithoutAWarning) {
  const RecentFiles recent = RecentFiles::load(list_named("none"));
  EXPECT_TRUE(recent.files().empty());
  EXPECT_EQ(recent.warning(), "");
}

TEST(RecentFiles, ListTheNewestFirst) {
  const fs::path file = list_named("order");
  RecentFiles recent = RecentFiles::load(file);
  ASSERT_TRUE(recent.add("/a.yaml"));
  ASSERT_TRUE(recent.add("/b.yaml"));
  ASSERT_TRUE(recent.add("/a.yaml"));
  const std::vector<fs::path> expected = {"/a.yaml", "/b.yaml"};
  EXPECT_EQ(RecentFiles::load(file).files(), expected);
}

TEST(RecentFiles, AreBounded) {
  const fs::path file = list_named("bounded");
  RecentFiles recent = RecentFiles::load(file);
  for (int i = 0; i < 20; ++i) ASSERT_TRUE(recent.add("/" + std::to_string(i) + ".yaml"));
  const std::vector<fs::path> files = RecentFiles::load(file).files();
  ASSERT_EQ(files.size(), RecentFiles::kMax);
  EXPECT_EQ(files.front(), "/19.yaml");
}

TEST(RecentFiles, KeepThoseOfAnotherWindow) {
  const fs::path file = list_named("two");
  RecentFiles one = RecentFiles::load(file);
  RecentFiles other = RecentFiles::load(file);
  ASSERT_TRUE(one.add("/one.yaml"));
  ASSERT_TRUE(other.add("/other.yaml"));
  const std::vector<fs::path> expected = {"/other.yaml", "/one.yaml"};
  EXPECT_EQ(RecentFiles::load(file).files(), expected);
}

TEST(RecentFiles, IgnoreABrokenFileWithAWarningThatNamesIt) {
  const std::string good = "thimble recent files 1\n";
  for (const std::string& text :
       {std::string("\x89PNG\r\n"), std::string(), good + "relative.yaml\n", good + "/a\x1b[2J\n",
        good + std::string(70000, 'x')}) {
    const fs::path file = with_text("broken", text);
    const RecentFiles recent = RecentFiles::load(file);
    EXPECT_TRUE(recent.files().empty()) << text.substr(0, 40);
    EXPECT_NE(recent.warning().find(file.string()), std::string::npos) << text.substr(0, 40);
  }
}

TEST(RecentFiles, ReplaceABrokenFile) {
  const fs::path file = with_text("repaired", "broken");
  RecentFiles recent = RecentFiles::load(file);
  ASSERT_TRUE(recent.add("/a.yaml"));
  EXPECT_EQ(RecentFiles::load(file).files(), std::vector<fs::path>{"/a.yaml"});
}

TEST(RecentFiles, AreWrittenWhole) {
  const fs::path file = list_named("whole");
  RecentFiles recent = RecentFiles::load(file);
  ASSERT_TRUE(recent.add("/a.yaml"));
  struct stat before {
  }, after{};
  ASSERT_EQ(stat(file.c_str(), &before), 0);
  std::ifstream reader(file);  // opened before the second write
  ASSERT_TRUE(recent.add("/b.yaml"));
  ASSERT_EQ(stat(file.c_str(), &after), 0);
  std::stringstream read;
  read << reader.rdbuf();
  EXPECT_EQ(read.str(), "thimble recent files 1\n/a.yaml\n");
  EXPECT_NE(before.st_ino, after.st_ino) << "the new file replaces the old one";
}

TEST(RecentFiles, OmitNamesWithALineBreak) {
  const fs::path file = list_named("break");
  RecentFiles recent = RecentFiles::load(file);
  ASSERT_TRUE(recent.add("/a\n/b.yaml"));
  EXPECT_TRUE(recent.files().empty());
}

TEST(RecentFiles, ReportAFolderThatCannotBeWritten) {
  const fs::path file = support::scratch_folder() / "recent_blocked" / "recent_scenes";
  fs::remove_all(file.parent_path());
  std::ofstream(file.parent_path()) << "a file in the way of the folder";
  RecentFiles recent = RecentFiles::load(file);
  EXPECT_FALSE(recent.add("/a.yaml"));
}

}  // namespace
}  // namespace thimble::view
