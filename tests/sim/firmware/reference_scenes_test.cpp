// Sessions whose simulated arm has the reference firmware, through its described wire.
#include <gtest/gtest.h>

#include <atomic>

#include "host_wire.h"
#include "reference_arm.h"
#include "support/shipped_scenes.h"
#include "thimble/scene/arm_file.h"
#include "thimble/session/session.h"

namespace thimble::firmware_test {
namespace {

std::unique_ptr<session::Session> open_with(const std::string& scene,
                                            const std::filesystem::path& arm) {
  session::SessionOptions options;
  options.mesh_folder = THIMBLE_MESHES;
  options.duration = 2;
  options.arm_file = arm;
  auto opened = session::Session::open(support::scene_file(scene), options);
  if (opened) return std::move(opened).value();
  ADD_FAILURE() << opened.error().message;
  return nullptr;
}

class ReferenceScene : public testing::TestWithParam<std::string> {};

// If the firmware kept its motors off, the tip would enter deeper and the force would be larger.
TEST_P(ReferenceScene, HasTheForcesOfThePublishedBoard) {
  const auto reference = open_with(GetParam(), reference_arm());
  const auto published = open_with(GetParam(), "vintage_phantom");
  ASSERT_TRUE(reference && published);
  const std::atomic<bool> stop{false};
  EXPECT_EQ(reference->run(stop), driver::ServoEnd::kDone);
  EXPECT_EQ(published->run(stop), driver::ServoEnd::kDone);
  const double force = published->statistics().force_max();
  EXPECT_GT(force, 0.05);
  EXPECT_NEAR(reference->statistics().force_max(), force, 0.02 * force);
}

INSTANTIATE_TEST_SUITE_P(ByName, ReferenceScene,
                         testing::Values("box", "sandpaper", "honey", "clay", "dominoes"),
                         [](const auto& scene) { return scene.param; });

TEST(ReferenceFiveBar, HasTheForcesOfThePublishedBoard) {
  const auto reference = open_with("disc", "reference_five_bar");
  const auto published = open_with("disc", "five_bar");
  ASSERT_TRUE(reference && published);
  const std::atomic<bool> stop{false};
  EXPECT_EQ(reference->run(stop), driver::ServoEnd::kDone);
  EXPECT_EQ(published->run(stop), driver::ServoEnd::kDone);
  const double force = published->statistics().force_max();
  EXPECT_GT(force, 0.3);
  EXPECT_NEAR(reference->statistics().force_max(), force, 0.02 * force);
}

TEST(ReferenceWire, DescriptionAgreesWithTheReadme) {
  const auto file = scene::load_arm(reference_arm());
  ASSERT_TRUE(file) << file.error().message;
  ASSERT_TRUE(file->wire);
  EXPECT_TRUE(file->simulated.firmware.reference);
}

TEST(ReferenceWire, BoardNeedsItsWire) {
  const auto path = support::scratch_folder() / "no_wire.yaml";
  {
    std::ifstream in(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml");
    std::stringstream text;
    text << in.rdbuf();
    std::ofstream(path) << std::regex_replace(text.str(), std::regex("\n    current_range:"),
                                              "\n    board: reference\n    current_range:");
  }
  const auto file = scene::load_arm(path);
  ASSERT_FALSE(file);
  EXPECT_NE(file.error().message.find("protocol: described"), std::string::npos)
      << file.error().message;
}

}  // namespace
}  // namespace thimble::firmware_test
