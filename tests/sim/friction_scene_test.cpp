// Frictions with their scene keys, on the elephant of the demo, and the errors for wrong values.

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>
#include <string>

#include "support/heap_guard.h"
#include "support/identify/rubbing.h"
#include "support/meshes/elephant.h"
#include "support/scratch.h"

namespace thimble {
namespace {

/// Writes the demo's scene with an effect on the elephant; `settings` go into its list entry.
std::filesystem::path scene_with(const std::string& settings) {
  std::ostringstream content;
  content << std::ifstream(support::elephant_scene()).rdbuf();
  std::string text = content.str();
  const auto put = [&text](const std::string& old_text, const std::string& new_text) {
    const auto at = text.find(old_text);
    ASSERT_NE(at, std::string::npos) << old_text;
    text.replace(at, old_text.size(), new_text);
  };
  put("damping: 1 ", "effects: [{" + settings + "}]\n    damping: 1 ");
  const auto file = support::scratch_folder() / "rubbed_elephant.yaml";
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file) << text;
  return file;
}

TEST(SceneWithFriction, EveryFrictionRunsWithoutAllocation) {
  THIMBLE_NEEDS_MESHES();
  for (const std::string& name : support::friction_names()) {
    session::SessionOptions options;
    options.mesh_folder = THIMBLE_MESHES;
    auto session =
        session::Session::open(scene_with("friction: " + name + ", coefficient: 0.4"), options);
    ASSERT_TRUE(session) << session.error().message;
    const std::atomic<bool> stop{false};
    driver::ServoEnd end{};
    EXPECT_EQ(support::heap_calls_of([&] { end = (*session)->run(stop); }), 0) << name;
    EXPECT_EQ(end, driver::ServoEnd::kDone) << name;
    EXPECT_GE((*session)->statistics().contacts(), 2U) << name;
    // The force along the surface is above zero, and at most the max. friction (of a stiction point
    // by default 1.25 times as much). The gate's rise limit has no effect while stroking.
    double most = 0;
    int rubbed = 0;
    for (const driver::TickRecord& row : (*session)->ticks()) {
      if (!row.in_contact) continue;
      const Eigen::Map<const Eigen::Vector3d> f_W(row.f_wanted_W.data()), n_W(row.n_W.data());
      const double normal = f_W.dot(n_W);
      const double along = (f_W - normal * n_W).norm();
      most = std::max(most, along - 0.5 * normal);
      if (along > 0.2 * normal) ++rubbed;
    }
    EXPECT_LE(most, 1e-9) << name;
    EXPECT_GT(rubbed, 100) << name;
  }
}

TEST(SceneWithFriction, SettingsThatOscillateAreRefused) {
  THIMBLE_NEEDS_MESHES();
  session::SessionOptions options;
  options.mesh_folder = THIMBLE_MESHES;
  const auto said = [&](const std::string& settings) {
    const auto session = session::Session::open(scene_with(settings), options);
    return session ? std::string() : session.error().message;
  };
  EXPECT_NE(said("friction: bristle, coefficient: 0.4, z_max: 0.00003")
                .find("z_max: friction would hold with"),
            std::string::npos);
  EXPECT_NE(said("friction: bristle, coefficient: -0.4").find("coefficient"), std::string::npos);
  EXPECT_NE(said("friction: bristle, coefficient: .nan").find("coefficient"), std::string::npos);
  EXPECT_EQ(said("friction: bristle"), "");
  EXPECT_NE(said("friction: glue, coefficient: 0.4").find("stiction_point"), std::string::npos);
  EXPECT_NE(said("friction: lugre, coefficient: 0.4, static_coefficient: 0.3")
                .find("static_coefficient: must not be below"),
            std::string::npos);
}

}  // namespace
}  // namespace thimble
