#include "view/compare/run_groups.h"

#include <gtest/gtest.h>

namespace thimble::view {
namespace {

using Groups = std::vector<std::vector<std::size_t>>;

/// A recording of an arm, and its file.
struct Named {
  std::string file;
  std::string arm;
  std::uint64_t seed = 1;
  std::size_t ticks = 3;
};

Groups groups_of(const std::vector<Named>& all) {
  std::vector<session::Recording> recordings;
  std::vector<std::filesystem::path> files;
  for (const Named& one : all) {
    session::Recording& made = recordings.emplace_back();
    made.info.scene_text = "name: hands";
    made.info.arm_in_scene = one.arm;
    made.info.seed = one.seed;
    made.ticks.resize(one.ticks);
    files.emplace_back(one.file);
  }
  return group_by_run(recordings, files);
}

TEST(RunGroups, EachRecordingOfOneArmIsARun) {
  EXPECT_EQ(groups_of({{"a.h5", ""}, {"b.h5", ""}}), (Groups{{0}, {1}}));
}

TEST(RunGroups, ArmsOfOneSceneAreOneRun) {
  EXPECT_EQ(groups_of({{"a_left.h5", "left", 1}, {"a_right.h5", "right", 2}}), (Groups{{0, 1}}));
  EXPECT_EQ(groups_of({{"1.h5", "left", 1}, {"2.h5", "right", 2}}), (Groups{{0, 1}}));
}

TEST(RunGroups, TwoRunsOfTwoArmsInAnyOrder) {
  EXPECT_EQ(groups_of({{"a_left.h5", "left"},
                       {"b_left.h5", "left"},
                       {"b_right.h5", "right"},
                       {"a_right.h5", "right"}}),
            (Groups{{0, 3}, {1, 2}}));
  EXPECT_EQ(groups_of({{"1.h5", "right", 1, 5},
                       {"2.h5", "left", 1, 4},
                       {"3.h5", ""},
                       {"4.h5", "right", 1, 4},
                       {"5.h5", "left", 90, 5}}),
            (Groups{{0}, {1, 3}, {2}, {4}}));
}

TEST(DistinctNames, AreFileNamesOrHaveFolders) {
  using Files = std::vector<std::filesystem::path>;
  using Names = std::vector<std::string>;
  EXPECT_EQ(distinct_names(Files{"/x/a.h5", "b.h5"}), (Names{"a.h5", "b.h5"}));
  EXPECT_EQ(distinct_names(Files{"mon/a.h5", "tue/a.h5"}), (Names{"mon/a.h5", "tue/a.h5"}));
  EXPECT_EQ(distinct_names(Files{"1/x/a.h5", "2/x/a.h5", "b.h5"}),
            (Names{"1/x/a.h5", "2/x/a.h5", "b.h5"}));
  EXPECT_EQ(distinct_names(Files{"a.h5", "./a.h5"}), (Names{"a.h5", "a.h5 (2)"}));
}

}  // namespace
}  // namespace thimble::view
