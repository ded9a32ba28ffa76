#include "view/start/start_entries.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "support/scratch.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

TEST(StartEntries, EachShippedSceneHasAStoredPicture) {
  for (const scene::ShippedFile& scene : scene::shipped_scenes()) {
    EXPECT_FALSE(stored_picture(scene.path).empty()) << scene.name;
  }
}

TEST(StartEntries, OwnScenesHaveNoStoredPicture) {
  const fs::path folder = support::scratch_folder() / "entries";
  fs::create_directories(folder / "scenes");
  std::ofstream(folder / "scenes/rubber.yaml") << "objects: []\n";
  EXPECT_TRUE(stored_picture(folder / "scenes/rubber.yaml").empty());
}

TEST(StartEntries, RecentFilesComeFirstIfTheyExist) {
  const fs::path folder = support::scratch_folder() / "entries";
  fs::create_directories(folder);
  std::ofstream(folder / "mine.yaml") << "description: Mine.\nobjects: []\n";
  fs::remove(folder / "recent");
  RecentFiles recent = RecentFiles::load(folder / "recent");
  ASSERT_TRUE(recent.add(folder / "mine.yaml"));
  ASSERT_TRUE(recent.add(folder / "removed.yaml"));
  const auto groups = start_groups(recent);
  ASSERT_GE(groups.size(), 2u);
  ASSERT_EQ(groups.front().entries.size(), 1u) << "a removed file has no card";
  EXPECT_EQ(groups.front().entries.front().about, "Mine.");
}

TEST(StartEntries, GroupsWithoutACardAreOmitted) {
  const fs::path none = support::scratch_folder() / "no_recent_list";
  for (const StartGroup& group : start_groups(RecentFiles::load(none))) {
    EXPECT_NE(group.title, "Recent");
    EXPECT_FALSE(group.entries.empty());
  }
}

TEST(StartEntries, SceneWithSeveralArmsIsRecognised) {
  const fs::path scenes = fs::path(THIMBLE_SOURCE_DIR) / "app/scenes";
  EXPECT_TRUE(entry_of({scenes / "two_hands.yaml", FileKind::kScene}).several_arms);
  EXPECT_FALSE(entry_of({scenes / "rubber.yaml", FileKind::kScene}).several_arms);
}

}  // namespace
}  // namespace thimble::view
