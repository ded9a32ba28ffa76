#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <string>
#include <vector>

#include "figures/lost_contacts.h"
#include "support/scratch.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

TEST(SeveralObjects, EachIsTouchedWithItsOwnStiffness) {
  const auto opened = session::Session::open(
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "tests/data/scenes/two_boxes.yaml", {});
  ASSERT_TRUE(opened) << opened.error().message;
  session::Session& session = **opened;
  ASSERT_EQ(session.run(std::atomic<bool>{false}), driver::ServoEnd::kDone);

  std::size_t ticks_on[2] = {0, 0};
  for (const auto& row : session.ticks()) {
    if (!row.in_contact) {
      EXPECT_EQ(row.object, -1);
      continue;
    }
    ASSERT_TRUE(row.object == 0 || row.object == 1);
    ++ticks_on[row.object];
    const auto& object = session.scene().objects[static_cast<std::size_t>(row.object)];
    const Eigen::Map<const Eigen::Vector3d> n(row.n_W.data()), v(row.v_WT.data()),
        f(row.f_wanted_W.data());
    const double push = object.stiffness * row.depth - object.damping * n.dot(v);
    EXPECT_LT((f - std::max(push, 0.0) * n).norm(), 1e-12) << "tick " << row.tick;
    // The left box lies at negative y, the right one at positive y.
    EXPECT_EQ(row.p_WT[1] > 0, row.object == 1);
  }
  EXPECT_GT(ticks_on[0], 300u);
  EXPECT_GT(ticks_on[1], 300u);
  EXPECT_EQ(session::count_lost_contacts(session.ticks(), session.touch()), 0u);
}

/// Runs a scene of tests/data/scenes and returns its ticks.
std::vector<driver::TickRecord> ticks_of(const std::string& scene) {
  const auto opened = session::Session::open(
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "tests/data/scenes" / (scene + ".yaml"), {});
  EXPECT_TRUE(opened) << opened.error().message;
  if (!opened) return {};
  session::Session& session = **opened;
  EXPECT_EQ(session.run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  EXPECT_EQ(session::count_lost_contacts(session.ticks(), session.touch()), 0u);
  return {session.ticks().begin(), session.ticks().end()};
}

TEST(SeveralObjects, ASeamOfFlushBoxesIsNotFelt) {
  int left = 0, right = 0;
  for (const auto& row : ticks_of("flush_boxes")) {
    if (!row.in_contact) continue;
    ++(row.object == 0 ? left : right);
    // The tops are at z = 0, so the depth is that of a single box.
    ASSERT_NEAR(row.depth, std::max(0.0, -row.p_WT[2]), 1e-9) << "tick " << row.tick;
    ASSERT_EQ(row.n_W[2], 1) << "tick " << row.tick;
  }
  EXPECT_GT(left, 300);
  EXPECT_GT(right, 300);
}

TEST(SeveralObjects, ABlockOnATableStopsATipThatPressesTheTable) {
  const auto ticks = ticks_of("block_on_table");
  ASSERT_FALSE(ticks.empty());
  const auto& last = ticks.back();
  // The side of the block is at x = 0.
  EXPECT_GT(last.p_WT[0], 0.002);
  EXPECT_NEAR(last.f_wanted_W[0], -800 * last.p_WT[0], 0.01);
  EXPECT_NEAR(last.f_wanted_W[2], -800 * last.p_WT[2], 0.01);
}

TEST(SeveralObjects, OverlappingPartsOfAMeshAreFeltAsTheirUnion) {
  const auto ticks = ticks_of("overlapping_parts");
  ASSERT_FALSE(ticks.empty());
  // The side of the post is at x = 0; it overlaps the plate that the tip presses.
  EXPECT_LT(ticks.back().f_wanted_W[0], -1);
}

TEST(BallTip, RestsInAGrooveOfTwoBoxesAtTheHeightOfItsRadius) {
  const auto ticks = ticks_of("ball_in_groove");
  ASSERT_FALSE(ticks.empty());
  int on_both = 0;
  for (const auto& row : ticks) {
    if (!row.in_contact) continue;
    // Both walls at 45 degrees: the centre is above the planes at the distance of the radius.
    const double left = (row.p_WP[0] + row.p_WP[2]) / std::numbers::sqrt2;
    const double right = (row.p_WP[2] - row.p_WP[0]) / std::numbers::sqrt2;
    ASSERT_GT(std::min(left, right), 0.004 - 1e-9) << "tick " << row.tick;
    if (std::max(left, right) < 0.004 + 1e-9) ++on_both;
  }
  EXPECT_GT(on_both, 500);
  EXPECT_NEAR(ticks.back().p_WP[2], 0.004 * std::numbers::sqrt2, 1e-9);
  EXPECT_GT(ticks.back().f_wanted_W[2], 1);
}

/// Runs a scene in a file and returns the positions and forces of its ticks.
std::vector<std::array<double, 6>> motion_of(const std::filesystem::path& file) {
  const auto opened = session::Session::open(file, {});
  EXPECT_TRUE(opened) << opened.error().message;
  std::vector<std::array<double, 6>> motion;
  if (!opened) return motion;
  EXPECT_EQ((*opened)->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  for (const auto& row : (*opened)->ticks()) {
    motion.push_back(
        {row.p_WT[0], row.p_WT[1], row.p_WT[2], row.f_sent_W[0], row.f_sent_W[1], row.f_sent_W[2]});
  }
  return motion;
}

TEST(BallTip, OfRadiusZeroIsAPoint) {
  const auto scene =
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "tests/data/scenes/flush_boxes.yaml";
  const auto with_key = support::scratch_folder() / "scene.yaml";
  std::filesystem::copy_file(scene, with_key, std::filesystem::copy_options::overwrite_existing);
  std::ofstream(with_key, std::ios::app) << "tool: {radius: 0}\n";
  const auto motion = motion_of(scene);
  EXPECT_GT(motion.size(), 1000u);
  EXPECT_EQ(motion_of(with_key), motion);
}

}  // namespace
}  // namespace thimble
