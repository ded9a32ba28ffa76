// Meshes that runs of similar scenes share: they exist once, give bit-identical runs, and never
// change.
#include "thimble/scene/shared_meshes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "mesh/contact_mesh.h"
#include "setup.h"
#include "support/meshes/shapes.h"
#include "support/run_hash.h"
#include "support/scratch.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_objects.h"
#include "thimble/session/session.h"

namespace thimble {
namespace {

using scene::SharedMeshes;
using session::Session;
using SharedStore = std::shared_ptr<SharedMeshes>;

class SharedMeshesTest : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::current_path(THIMBLE_SOURCE_DIR); }

  /// Opens a scene that shares `meshes`, changed by `adjust`; fails the test if it cannot.
  static std::unique_ptr<Session> open(const std::filesystem::path& scene, SharedStore meshes,
                                       std::function<void(scene::Scene&)> adjust = {}) {
    auto opened = Session::open(
        scene, {.duration = 2, .adjust = std::move(adjust), .meshes = std::move(meshes)});
    if (!opened) {
      ADD_FAILURE() << opened.error().message;
      return nullptr;
    }
    return std::move(opened).value();
  }
  /// Writes a scene with its own ball.
  static std::filesystem::path ball_scene(double radius) {
    const auto folder = support::scratch_folder() / "shared_meshes";
    std::filesystem::create_directories(folder);
    const auto saved = render::save_mesh(support::icosphere(2, radius), folder / "ball.off");
    EXPECT_TRUE(saved);
    std::ofstream(folder / "scene.yaml") << "name: ball\narm: vintage_phantom\nduration: 1\n"
                                            "objects:\n"
                                            "  - {name: ball, mesh: ball.off, scale: 1, "
                                            "position: [0, 0, -0.03], stiffness: 500, damping: 1, "
                                            "contact: {tracker: edge_planes}}\n"
                                            "hand:\n  path:\n    - {t: 0, at: [0, 0, 0.02]}\n";
    return folder / "scene.yaml";
  }
  static const render::ContactMesh* touched(const Session& run, std::size_t arm = 0) {
    return run.setup().objects().touch(arm).object(0).mesh();
  }
  static const render::TriangleMesh* drawn(const Session& run) {
    return run.setup().objects().shared_mesh_W(0).get();
  }
  static std::uint64_t hash_of(Session& run) {
    run.run();
    support::RunHash hash;
    for (const driver::TickRecord& row : run.ticks()) hash.add(row);
    return hash.value();
  }
};

TEST_F(SharedMeshesTest, ExistOnceForRunsOfOneScene) {
  const auto scene = ball_scene(0.03);
  const auto meshes = std::make_shared<SharedMeshes>();
  const auto first = open(scene, meshes), second = open(scene, meshes), alone = open(scene, {});
  ASSERT_NE(touched(*first), nullptr);
  EXPECT_EQ(touched(*first), touched(*second));
  EXPECT_EQ(drawn(*first), drawn(*second));
  EXPECT_EQ(&first->setup().objects().mesh_W(), drawn(*first)) << "of one object, all is itself";
  EXPECT_EQ(meshes->meshes(), 1U);
  EXPECT_EQ(meshes->surfaces(), 1U);
  EXPECT_NE(touched(*first), touched(*alone));
  EXPECT_NE(drawn(*first), drawn(*alone));
}

TEST_F(SharedMeshesTest, DependOnPlaceSizeAndContact) {
  const auto scene = ball_scene(0.03);
  const auto meshes = std::make_shared<SharedMeshes>();
  const auto plain = open(scene, meshes);
  const auto offset = open(scene, meshes, [](scene::Scene& read) {
    read.objects[0].contact.tracker = render::TrackerChoice::kOffset;
  });
  EXPECT_EQ(drawn(*plain), drawn(*offset));
  EXPECT_NE(touched(*plain), touched(*offset));
  const auto stiffer =
      open(scene, meshes, [](scene::Scene& read) { read.objects[0].stiffness = 300; });
  EXPECT_EQ(touched(*plain), touched(*stiffer)) << "what is felt there does not change the mesh";
  const auto aside =
      open(scene, meshes, [](scene::Scene& read) { read.objects[0].p_WO.x() = 0.01; });
  const auto larger = open(scene, meshes, [](scene::Scene& read) { read.objects[0].scale = 1.1; });
  EXPECT_NE(drawn(*plain), drawn(*aside));
  EXPECT_NE(drawn(*plain), drawn(*larger));
  EXPECT_EQ(drawn(*aside)->vertices[0].x(), drawn(*plain)->vertices[0].x() + 0.01);
  EXPECT_EQ(meshes->meshes(), 3U);
  EXPECT_EQ(meshes->surfaces(), 4U);
}

/// Returns a scene of spheres in a row, and a hand that stays away from them.
std::string sphere_scene(int count) {
  std::string text = "name: spheres\narm: vintage_phantom\nduration: 0.01\nobjects:\n";
  for (int i = 0; i < count; ++i) {
    text += "  - {name: s" + std::to_string(i) + ", sphere: {radius: 0.001}, position: [" +
            std::to_string(1e-4 * i) + ", 0, -0.03], stiffness: 400}\n";
  }
  return text + "hand:\n  path:\n    - {t: 0, at: [0, 0, 0.02]}\n";
}

TEST_F(SharedMeshesTest, OfShapesAreMadeOnceWhenTheyAreAskedFor) {
  const auto file = support::scratch_folder() / "three_spheres.yaml";
  std::ofstream(file) << sphere_scene(3);
  const auto meshes = std::make_shared<SharedMeshes>();
  const auto run = open(file, meshes);
  const scene::SceneObjects& objects = run->setup().objects();
  EXPECT_EQ(meshes->meshes(), 0U);
  EXPECT_FALSE(objects.mesh_W(1).triangles.empty());
  EXPECT_EQ(meshes->meshes(), 1U);
  std::vector<std::thread> threads;
  std::vector<const render::TriangleMesh*> all(8);
  for (std::size_t i = 0; i < all.size(); ++i) {
    threads.emplace_back([&, i] { all[i] = &objects.mesh_W(); });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(std::count(all.begin(), all.end(), all[0]), 8);
  EXPECT_EQ(meshes->meshes(), 4U) << "three and all of them";
  const std::size_t vertices = objects.mesh_W(0).vertices.size();
  EXPECT_EQ(objects.mesh_W().vertices.size(), 3 * vertices);
  EXPECT_EQ(objects.place(2).vertex, 2 * vertices);
  EXPECT_EQ(objects.mesh_W().vertices[2 * vertices], objects.mesh_W(2).vertices[0]);
  const auto again = open(file, meshes);
  EXPECT_EQ(&again->setup().objects().mesh_W(), all[0]);
  EXPECT_EQ(meshes->meshes(), 4U);
}

TEST_F(SharedMeshesTest, ARunOfManyShapesMakesNone) {
  const auto file = support::scratch_folder() / "many_spheres.yaml";
  std::ofstream(file) << sphere_scene(10'000);
  const auto meshes = std::make_shared<SharedMeshes>();
  const auto run = open(file, meshes);
  ASSERT_NE(run, nullptr);
  run->run();
  EXPECT_EQ(run->scene().objects.size(), 10'000U);
  EXPECT_EQ(meshes->meshes(), 0U);
}

TEST_F(SharedMeshesTest, AreReadAgainIfTheirFileHasChanged) {
  const auto meshes = std::make_shared<SharedMeshes>();
  const auto before = open(ball_scene(0.03), meshes);
  const auto scene = ball_scene(0.02);  // same number of digits, so the file may have the same size
  std::filesystem::last_write_time(
      scene.parent_path() / "ball.off",
      std::filesystem::last_write_time(scene) + std::chrono::seconds(2));
  const auto after = open(scene, meshes);
  EXPECT_NE(drawn(*before), drawn(*after));
  EXPECT_NEAR((drawn(*after)->vertices[0] - Eigen::Vector3d(0, 0, -0.03)).norm(), 0.02, 1e-9);
}

TEST_F(SharedMeshesTest, AreKeptWhileInUse) {
  const auto meshes = std::make_shared<SharedMeshes>();
  auto run = open(ball_scene(0.03), meshes);
  meshes->drop_unused();
  EXPECT_EQ(meshes->meshes(), 1U);
  EXPECT_EQ(meshes->surfaces(), 1U);
  run.reset();
  EXPECT_EQ(meshes->surfaces(), 1U) << "for the next one";
  meshes->drop_unused();
  EXPECT_EQ(meshes->meshes(), 0U);
  EXPECT_EQ(meshes->surfaces(), 0U);
}

TEST_F(SharedMeshesTest, AreSharedByTheArmsOfAScene) {
  // A ball at rest replaces the beam.
  const auto mesh = ball_scene(0.03).parent_path() / "ball.off";
  const auto with_ball = [&mesh](scene::Scene& read) {
    scene::SceneObject ball;
    ball.name = "ball";
    ball.mesh_file = mesh;
    ball.scale = 1;
    ball.stiffness = 500;
    ball.tracker_named = true;  // edge planes, whose mesh can be compared
    read.objects[0] = ball;
  };
  const auto opened = Session::open("two_hands", {.adjust = with_ball, .several_arms = true});
  ASSERT_TRUE(opened) << opened.error().message;
  ASSERT_NE(touched(**opened, 0), nullptr);
  EXPECT_EQ(touched(**opened, 0), touched(**opened, 1));
}

// Dents, prints and snapped walls of one run do not appear in another.
TEST_F(SharedMeshesTest, OfDeformingObjectsAreNotChanged) {
  for (const char* name : {"trampoline", "clay", "tin_can"}) {
    const auto meshes = std::make_shared<SharedMeshes>();
    const auto pressed = open(name, meshes), other = open(name, meshes), alone = open(name, {});
    const render::TriangleMesh before = other->mesh_now();
    double deepest = 0;
    while (!pressed->step()) {
      const render::TriangleMesh now = pressed->mesh_now();
      for (std::size_t v = 0; v < now.vertices.size(); ++v) {
        deepest = std::max(deepest, (now.vertices[v] - before.vertices[v]).norm());
      }
    }
    EXPECT_GT(deepest, 2e-4) << name;
    EXPECT_EQ(other->mesh_now().vertices, before.vertices) << name;
    EXPECT_EQ(drawn(*pressed)->vertices, drawn(*alone)->vertices) << name;
    EXPECT_EQ(hash_of(*other), hash_of(*alone)) << name;
  }
}

TEST_F(SharedMeshesTest, AreThreadSafe) {
  const auto scene = std::filesystem::path(THIMBLE_SOURCE_DIR) / "tests/data/scenes/two_boxes.yaml";
  const std::uint64_t expected = hash_of(*open(scene, {}));
  const auto meshes = std::make_shared<SharedMeshes>();
  std::vector<std::uint64_t> hashes(4);
  {
    std::vector<std::jthread> threads;
    for (std::uint64_t& hash : hashes) {
      threads.emplace_back([&] { hash = hash_of(*open(scene, meshes)); });
    }
  }
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, expected);
}

}  // namespace
}  // namespace thimble
