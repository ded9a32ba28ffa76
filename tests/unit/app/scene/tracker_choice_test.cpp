// The tracker of an object that names none: what is chosen, that it is felt as if it were named,
// and how it is reported.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "support/meshes/made_solids.h"
#include "support/meshes/shapes.h"
#include "support/scratch.h"
#include "thimble/driver/device_state.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/quality.h"
#include "thimble/scene/scene_file.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/scene/shared_meshes.h"

namespace thimble::scene {
namespace {

using Eigen::Vector3d;
using render::TrackerChoice;

class TrackerOfScene : public ::testing::Test {
 protected:
  void SetUp() override {
    std::filesystem::create_directories(folder_);
    const auto put = [this](const std::string& name, const render::TriangleMesh& mesh) {
      ASSERT_TRUE(render::save_mesh(mesh, folder_ / name));
    };
    put("ball.off", support::icosphere(3, 0.02));
    put("die.off",
        support::split_in_plane(support::split_in_plane(support::box({0.02, 0.02, 0.02}))));
    const double in = 0.004 * std::tan(std::numbers::pi / 6);
    put("pin.off",
        support::turned(
            {{0.02 - in, 0.016}, {0.02, 0.012}, {0.02, 0.004}, {0.02, -0.004}, {0.02, -0.012}},
            64));
  }

  /// Returns an object of a scene.
  static std::string object(const std::string& name, const std::string& mesh,
                            const std::string& more = "") {
    return "  - {name: " + name + ", mesh: " + mesh + ", scale: 1, stiffness: 500, damping: 1" +
           (more.empty() ? "" : ", " + more) + "}\n";
  }

  driver::Result<Scene> read(const std::string& objects, const std::string& more = "") const {
    std::ofstream(folder_ / "scene.yaml")
        << "name: chosen\narm: " << THIMBLE_SOURCE_DIR
        << "/app/arms/vintage_phantom.yaml\nduration: 1\nobjects:\n"
        << objects << "hand:\n  path:\n    - {t: 0, at: [0, 0, 0.05]}\n"
        << more;
    return load_scene(folder_ / "scene.yaml");
  }

  /// Returns the objects of a scene, and the scene; fails the test on an error.
  std::unique_ptr<SceneObjects> built(const std::string& objects, Scene& scene,
                                      const std::string& more = "") const {
    auto loaded = read(objects, more);
    if (!loaded) {
      ADD_FAILURE() << loaded.error().message;
      return nullptr;
    }
    scene = std::move(loaded).value();
    return built(scene);
  }
  static std::unique_ptr<SceneObjects> built(const Scene& scene) {
    auto objects = SceneObjects::build(scene);
    if (!objects) {
      ADD_FAILURE() << objects.error().message;
      return nullptr;
    }
    return std::move(objects).value();
  }

  /// Returns the forces on a tip that strokes an object from above, over its edge.
  std::vector<Vector3d> stroke(const std::string& objects) const {
    Scene scene;
    const auto touched = built(objects, scene);
    std::vector<Vector3d> forces;
    if (!touched) return forces;
    driver::DeviceState state;
    state.dt = 1e-3;
    state.fresh = true;
    for (int i = 0; i < 800; ++i) {
      state.tick = static_cast<std::uint64_t>(i);
      const double down = std::min(0.03, 1e-4 * i), aside = 6e-5 * std::max(0, i - 300);
      state.p_WT = Vector3d(0.004 + aside, 0.003, 0.045 - down);
      state.v_WT = Vector3d(i < 300 ? 0 : 0.06, 0, i < 300 ? -0.1 : 0);
      forces.push_back(touched->touch()(state).f_T_W);
    }
    return forces;
  }

  std::filesystem::path folder_ = support::scratch_folder() / "tracker_choice";
};

double largest(const std::vector<Vector3d>& forces) {
  double all = 0;
  for (const Vector3d& force : forces) all = std::max(all, force.norm());
  return all;
}

TEST_F(TrackerOfScene, IsFeltAsIfItWereNamed) {
  for (const auto& [mesh, tracker] :
       {std::pair{"ball.off", "compact"}, {"die.off", "edge_planes"}}) {
    const auto chosen = stroke(object("it", mesh));
    EXPECT_GT(largest(chosen), 0.5) << mesh;
    EXPECT_EQ(chosen, stroke(object("it", mesh, "contact: {tracker: auto}"))) << mesh;
    EXPECT_EQ(chosen,
              stroke(object("it", mesh, std::string("contact: {tracker: ") + tracker + "}")))
        << mesh;
  }
}

TEST_F(TrackerOfScene, DiffersBetweenSmoothAndFlat) {
  EXPECT_NE(stroke(object("it", "ball.off")),
            stroke(object("it", "ball.off", "contact: {tracker: edge_planes}")));
}

TEST_F(TrackerOfScene, KeepsACreaseAngleOfTheScene) {
  Scene scene;
  const auto chosen = built(object("pin", "pin.off"), scene);
  ASSERT_TRUE(chosen);
  ASSERT_TRUE(chosen->trackers()[0].contact.crease_angle);
  EXPECT_LT(*chosen->trackers()[0].contact.crease_angle, 0.5);
  const auto named = built(object("pin", "pin.off", "contact: {crease_degrees: 40}"), scene);
  ASSERT_TRUE(named);
  EXPECT_EQ(named->trackers()[0].contact.tracker, TrackerChoice::kPacked);
  EXPECT_NEAR(*named->trackers()[0].contact.crease_angle, 40 * std::numbers::pi / 180, 1e-12);
}

TEST_F(TrackerOfScene, IsReportedInALineForAllAlike) {
  std::string objects = object("ball", "ball.off") + object("pin", "pin.off") +
                        object("named", "die.off", "contact: {tracker: offset}") +
                        "  - {name: wall, plane: {normal: [0, 0, 1]}, stiffness: 100}\n";
  for (const char* name : {"a", "b", "c", "d", "e"}) objects += object(name, "die.off");
  Scene scene;
  const auto built_objects = built(objects, scene);
  ASSERT_TRUE(built_objects);
  const std::vector<std::string> lines = built_objects->tracker_notes(scene);
  ASSERT_EQ(lines.size(), 3U);
  EXPECT_EQ(lines[0].find("ball: compact (smooth: 100 % of the area curves, by "), 0U) << lines[0];
  EXPECT_EQ(lines[1].find("pin: compact (smooth: "), 0U) << lines[1];
  EXPECT_NE(lines[1].find("; edges of more than "), std::string::npos) << lines[1];
  EXPECT_EQ(lines[2], "a, b, c and 2 more: edge_planes (faceted: 100 % of the area is flat)");
  ASSERT_EQ(built_objects->trackers().size(), 8U) << "a wall has none";
  EXPECT_FALSE(built_objects->trackers()[2].chosen);
  EXPECT_EQ(built_objects->trackers()[2].contact.tracker, TrackerChoice::kOffset);
}

TEST_F(TrackerOfScene, IsOneThatSupportsTheOtherKeys) {
  for (const auto& [more, tracker, reason] :
       {std::tuple{"contact: {blending: phong}", TrackerChoice::kEdgePlanes, "blending is set"},
        {"contact: {tracker: auto, curved_depth: true}", TrackerChoice::kEdgePlanes,
         "curved_depth is set"},
        {"contact: {normals: round}", TrackerChoice::kEdgePlanes, "normals is set"},
        {"contact: {search: tree}", TrackerChoice::kPacked, "smooth: "},
        {"repair: true", TrackerChoice::kEdgePlanes, "its mesh is repaired"},
        {"open: {thickness: 0.001}", TrackerChoice::kGodObject, "a sheet"},
        {"open: {thickness: 0.001}, contact: {tracker: auto}", TrackerChoice::kGodObject,
         "a sheet"},
        {"body: {dent: {}}", TrackerChoice::kEdgePlanes, "its surface dents"},
        {"body: {plastic: {yield_force: 1, radius: 0.005}}", TrackerChoice::kEdgePlanes,
         "its shape changes"},
        {"body: {plastic: {yield_force: 1, radius: 0.005, edge: 0.001}}", TrackerChoice::kGodObject,
         "its triangles are split"},
        {"body: {motion: {mass: 0.1}}", TrackerChoice::kPacked, "smooth: "}}) {
    Scene scene;
    const auto objects = built(object("ball", "ball.off", more), scene);
    ASSERT_TRUE(objects) << more;
    const ObjectTracker& found = objects->trackers().at(0);
    EXPECT_EQ(found.contact.tracker, tracker) << more;
    EXPECT_TRUE(found.chosen) << more;
    EXPECT_EQ(found.reason.find(reason), 0U) << more << ": " << found.reason;
  }
}

TEST_F(TrackerOfScene, RefusesAnUnknownNameWithTheKnownOnes) {
  const auto wrong = read(object("ball", "ball.off", "contact: {tracker: automatic}"));
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().message.find("auto, edge_planes"), std::string::npos)
      << wrong.error().message;
}

TEST_F(TrackerOfScene, IsNotUsedByATipWithARadius) {
  Scene scene;
  const auto objects = built(object("ball", "ball.off"), scene, "tool: {radius: 0.004}\n");
  ASSERT_TRUE(objects);
  EXPECT_TRUE(objects->tracker_notes(scene).empty());
  EXPECT_FALSE(objects->trackers().at(0).chosen);
}

TEST_F(TrackerOfScene, OfAQualityIsKept) {
  for (const auto& [quality, tracker] : {std::pair{Quality::kDraft, TrackerChoice::kEdgePlanes},
                                         {Quality::kReference, TrackerChoice::kEdgePlanes}}) {
    for (const char* contact : {"", "contact: {tracker: auto}"}) {
      auto scene = read(object("ball", "ball.off", contact));
      ASSERT_TRUE(scene.ok());
      apply_quality(quality, *scene);
      const auto objects = built(*scene);
      ASSERT_TRUE(objects);
      EXPECT_EQ(objects->trackers().at(0).contact.tracker, tracker);
    }
  }
}

TEST_F(TrackerOfScene, OfQualityAutoIsThatOfItsTable) {
  for (const double budget : {1.0, 1000.0}) {
    auto scene = read(object("ball", "ball.off", "contact: {tracker: auto}"));
    ASSERT_TRUE(scene.ok());
    apply_quality(Quality::kAuto, *scene, budget);
    const auto objects = built(*scene);
    ASSERT_TRUE(objects);
    EXPECT_EQ(objects->trackers().at(0).contact, scene->objects[0].contact);
    EXPECT_FALSE(objects->trackers().at(0).chosen);
    EXPECT_TRUE(objects->tracker_notes(*scene).empty());
  }
}

TEST_F(TrackerOfScene, IsChosenOnceForRunsThatShareMeshes) {
  auto scene = read(object("ball", "ball.off"));
  ASSERT_TRUE(scene.ok());
  const auto meshes = std::make_shared<SharedMeshes>();
  const auto mesh = meshes->object_mesh(scene->objects[0]);
  ASSERT_TRUE(mesh.ok());
  const auto first = meshes->tracker(*mesh);
  EXPECT_EQ(first, meshes->tracker(*mesh));
}

}  // namespace
}  // namespace thimble::scene
