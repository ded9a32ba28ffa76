#include <gtest/gtest.h>

#include <Eigen/Core>
#include <filesystem>
#include <fstream>
#include <string>

#include "support/scratch.h"
#include "thimble/scene/scene_file.h"

// List `arms` of a scene.

namespace thimble {
namespace {

const std::filesystem::path kFolder = support::scratch_folder() / "scene_arms";

/// Reads a scene of several arms; `arms` are the entries, `more` further lines.
driver::Result<scene::Scene> read_several(const std::string& arms, const std::string& more = "") {
  std::filesystem::create_directories(kFolder);
  std::filesystem::copy_file(
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml",
      kFolder / "arm.yaml", std::filesystem::copy_options::overwrite_existing);
  std::ofstream(kFolder / "several.yaml")
      << "name: test\nduration: 2\n" + more + "arms:\n" + arms +
             "objects:\n  - {name: ball, sphere: {radius: 0.02}, stiffness: 500}\n";
  return scene::load_scene(kFolder / "several.yaml", {.several_arms = true});
}

/// Returns an entry of `arms`, a line.
std::string arm_entry(const std::string& name, const std::string& more = "") {
  return "  - {name: " + name + ", arm: arm.yaml" + more +
         ", hand: {path: [{t: 0, at: [0, 0, 0.05]}]}}\n";
}

TEST(SceneArms, PlacesEachOfSeveralArms) {
  const auto scene =
      read_several(arm_entry("left") +
                       arm_entry("right", ", at: {position: [0.01, 0.2, 0.03], turn_degrees: 90}"),
                   "faults: apart\n");
  ASSERT_TRUE(scene) << scene.error().message;
  EXPECT_EQ(scene->arms.front().name, "left");
  EXPECT_EQ(scene->faults, scene::FaultRule::kApart);
  ASSERT_EQ(scene->arms.size(), 2U);
  const scene::SceneArm& right = scene->arms[1];
  EXPECT_EQ(right.name, "right");
  EXPECT_EQ(right.hand.size(), 1U);
  const Eigen::Vector3d p = scene->arms.front().arm.p_WB;  // place of the arm without `at`
  const Eigen::Vector3d placed(-p.y() + 0.01, p.x() + 0.2, p.z() + 0.03);
  EXPECT_LT((right.arm.p_WB - placed).norm(), 1e-15);
  Eigen::Matrix3d R;
  R << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  EXPECT_EQ(right.arm.R_WB, R * scene->arms.front().arm.R_WB);
  EXPECT_LT((right.arm.workspace.min_W - Eigen::Vector3d(-0.09, 0.1, -0.07)).norm(), 1e-12);
  EXPECT_LT((right.arm.workspace.max_W - Eigen::Vector3d(0.11, 0.3, 0.13)).norm(), 1e-12);
  EXPECT_EQ(read_several(arm_entry("a") + arm_entry("b"))->faults, scene::FaultRule::kTogether);
}

TEST(SceneArms, ReportsMistakesInSeveralArms) {
  const auto says = [](const std::string& arms, const std::string& said,
                       const std::string& more = "") {
    const auto scene = read_several(arms, more);
    const std::string message = scene ? "" : scene.error().message;
    EXPECT_NE(message.find(said), std::string::npos) << "found: " << message;
  };
  const std::string two = arm_entry("left") + arm_entry("right");
  says(arm_entry("left"), "arms: expected two arms or more");
  says(arm_entry("left") + arm_entry("left"), "expected different names, found \"left\" twice");
  says(two, "hand: cannot be used with arms", "hand: {path: [{t: 0, at: [0, 0, 0]}]}\n");
  says(two, "arm: cannot be used with arms", "arm: arm.yaml\n");
  says(two, "at: is the place of one arm", "at: {turn_degrees: 90}\n");
  for (const std::string key : {"tool: {radius: 0.003}", "rate: 500", "faults: apart"}) {
    says(arm_entry("left") + arm_entry("right", ", " + key),
         key.substr(0, key.find(':')) + ": applies to the whole scene");
  }
  says(arm_entry("left") + arm_entry("../x"), "name: expected letters, digits and _");
  says(two, "faults", "faults: never\n");
  says(arm_entry("left") + arm_entry("right", ", at: {turn_degrees: 45}"),
       "turn_degrees: expected a multiple of 90");
  says(arm_entry("left") + arm_entry("right", ", at: {turned: 90}"), "turned");
  says(arm_entry("left") + "  - {name: right, arm: no_such_arm, hand: {path: []}}\n",
       "The arm \"right\": ");
  says(arm_entry("left") + "  - {name: right, arm: arm.yaml}\n", "hand");
  std::string nine;
  for (int i = 0; i < 9; ++i) nine += arm_entry("a" + std::to_string(i));
  says(nine, "at most 8 arms, found 9");
}

TEST(SceneArms, ReaderForOneArmNamesTheArms) {
  ASSERT_TRUE(read_several(arm_entry("left") + arm_entry("right")));
  const auto scene = scene::load_scene(kFolder / "several.yaml");
  ASSERT_FALSE(scene);
  EXPECT_NE(scene.error().message.find("(left, right)"), std::string::npos)
      << scene.error().message;
}

}  // namespace
}  // namespace thimble
