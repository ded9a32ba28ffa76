#include "view/start/opened_file.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "support/scratch.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

fs::path file_named(const std::string& name) {
  const fs::path folder = support::scratch_folder() / "opened";
  fs::create_directories(folder);
  std::ofstream(folder / name) << "x";
  return folder / name;
}

TEST(OpenedFile, PathIsWithoutBlanksAndQuotes) {
  EXPECT_EQ(path_in("  /a b.stl \n"), "/a b.stl");
  EXPECT_EQ(path_in("'/a b.stl'"), "/a b.stl");
  EXPECT_EQ(path_in("\"/a b.stl\""), "/a b.stl");
}

TEST(OpenedFile, PathOfAnAddressIsDecoded) {
  EXPECT_EQ(path_in("file:///a%20b.stl"), "/a b.stl");
  EXPECT_EQ(path_in("file://host/100%.stl"), "/100%.stl");
  EXPECT_EQ(path_in("file:///a%2"), "/a%2");
  EXPECT_EQ(path_in("file://"), "");
}

TEST(OpenedFile, TildeIsTheHomeFolder) {
  setenv("HOME", "/home/me", 1);
  EXPECT_EQ(path_in("~/a.stl"), "/home/me/a.stl");
  EXPECT_EQ(path_in("~other/a.stl"), "~other/a.stl");
}

TEST(OpenedFile, KindFollowsTheExtension) {
  const auto kind = [](const char* name) { return open_text(file_named(name).string())->kind; };
  EXPECT_EQ(kind("a.yaml"), FileKind::kScene);
  EXPECT_EQ(kind("a.STL"), FileKind::kMesh);
  EXPECT_EQ(kind("a.glb"), FileKind::kMesh);
  EXPECT_EQ(kind("a.h5"), FileKind::kRecording);
}

TEST(OpenedFile, NameOfASceneIsAccepted) {
  const auto opened = open_text("rubber");
  ASSERT_TRUE(opened) << opened.error().message;
  EXPECT_EQ(opened->file.filename(), "rubber.yaml");
}

TEST(OpenedFile, ErrorNamesProblemAndRemedy) {
  const auto error_of = [](const std::string& text) { return open_text(text).error().message; };
  EXPECT_NE(error_of(" ").find("Type"), std::string::npos);
  EXPECT_NE(error_of("/no/such.stl").find("/no/such.stl"), std::string::npos);
  EXPECT_NE(error_of("/tmp").find("folder"), std::string::npos);
  EXPECT_NE(error_of(file_named("a.txt").string()).find(".yaml"), std::string::npos);
}

}  // namespace
}  // namespace thimble::view
