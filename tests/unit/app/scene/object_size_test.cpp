#include "meshes/object_mesh.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "compact_mesh/packed_surface.h"
#include "disk_paging/page_file.h"
#include "mesh/contact_mesh.h"
#include "support/meshes/shapes.h"
#include "support/scratch.h"
#include "thimble/scene/scene_objects.h"

namespace thimble::scene {
namespace {

const std::filesystem::path kSmallMeshes =
    std::filesystem::path(THIMBLE_SOURCE_DIR) / "tests/data/meshes";

// A scene of one mesh, and an arm with a workspace of 0.2 m.
Scene scene_of(const std::string& mesh) {
  Scene scene;
  scene.rate = 1000;
  scene.arms.front().arm.workspace = {.min_W = {-0.1, -0.1, -0.1}, .max_W = {0.1, 0.1, 0.1}};
  SceneObject object;
  object.name = "part";
  object.mesh_file = kSmallMeshes / mesh;
  object.stiffness = 500;
  scene.objects.push_back(object);
  return scene;
}

TEST(ObjectSize, RefusesAPartInMillimetresWithoutScale) {
  const auto objects = SceneObjects::build(scene_of("mm50.stl"));
  ASSERT_FALSE(objects.ok());
  EXPECT_EQ(objects.error().message,
            (kSmallMeshes / "mm50.stl").string() +
                ": 50 m large, 250 times the reach of the arm (0.2 m); STL names no unit: set "
                "scale: 0.001 if its unit is mm, or size (m).");
}

TEST(ObjectSize, AcceptsAPartInMillimetresWithScaleOrSize) {
  Scene scene = scene_of("mm50.stl");
  scene.objects[0].scale = 0.001;
  EXPECT_TRUE(SceneObjects::build(scene).ok());
  scene.objects[0].scale.reset();
  scene.objects[0].size = 0.05;
  EXPECT_TRUE(SceneObjects::build(scene).ok());
}

TEST(ObjectSize, RejectsHugeMeshesWithAnyUnit) {
  Scene scene = scene_of("mm50.stl");
  scene.objects[0].scale = 1;
  const auto objects = SceneObjects::build(scene);
  ASSERT_FALSE(objects.ok());
  EXPECT_NE(objects.error().message.find("at most 100 times are supported. Set a smaller scale."),
            std::string::npos)
      << objects.error().message;
}

TEST(ObjectSize, ReportsALargeMeshWithoutAUnit) {
  const auto objects = SceneObjects::build(scene_of("box.off"));
  ASSERT_TRUE(objects.ok()) << objects.error().message;
  ASSERT_EQ((*objects)->notes().size(), 1U);
  EXPECT_NE((*objects)->notes()[0].find(
                "3 m large, 15 times the reach of the arm (0.2 m); OFF names no unit"),
            std::string::npos)
      << (*objects)->notes()[0];
}

TEST(ObjectSize, IsSilentIfTheSizeIsSet) {
  SceneObject stated;
  stated.size = 10;
  EXPECT_EQ(*judge_size(stated, {.side = 10, .kind = "STL", .has_unit = false}, 0.2), "");
  const SceneObject plain{};
  EXPECT_EQ(*judge_size(plain, {.side = 10, .kind = "GLTF", .has_unit = true}, 0.2), "");
  EXPECT_EQ(*judge_size(plain, {.side = 10, .kind = "STL", .has_unit = false}, 0), "");
}

TEST(ObjectSize, UsesTheLargestOfSeveralArms) {
  Scene scene = scene_of("box.off");
  EXPECT_DOUBLE_EQ(reach_of(scene), 0.2);
  scene.arms.emplace_back();
  scene.arms[1].arm.workspace = {.min_W = {-1, 0, 0}, .max_W = {1, 0.1, 0.1}};
  EXPECT_DOUBLE_EQ(reach_of(scene), 2);
  EXPECT_DOUBLE_EQ(reach_of(Scene()), 0);
}

TEST(ObjectMesh, ReportsPartsThatOverlap) {
  SceneObject object = scene_of("overlap.obj").objects[0];
  object.size = 0.06;
  const auto mesh = load_object_mesh(object);
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  ASSERT_EQ(mesh->notes.size(), 1U);
  EXPECT_NE(mesh->notes[0].find("overlap.obj: 1 pair of parts overlap or lie flush"),
            std::string::npos);
}

TEST(ObjectMesh, ReportsPartsThatWereInsideOut) {
  SceneObject object = scene_of("inside_out.off").objects[0];
  object.size = 0.06;
  const auto mesh = load_object_mesh(object);
  ASSERT_TRUE(mesh.ok()) << mesh.error().message;
  ASSERT_EQ(mesh->notes.size(), 1U);
  EXPECT_NE(mesh->notes[0].find("12 triangles were reversed"), std::string::npos) << mesh->notes[0];
}

TEST(ObjectSize, OfPagesIsTheirLargestSideInTheWorld) {
  const auto mesh = render::ContactMesh::build(support::box({0.01, 0.02, 0.005}));
  ASSERT_TRUE(mesh);
  const auto path = support::scratch_folder() / "sides.pages";
  const auto surface = render::PackedSurface::build(*mesh);
  ASSERT_TRUE(surface) << surface.error().message;
  ASSERT_TRUE(render::write_page_file(*surface, path));
  const auto file = render::PageFile::open(path);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_NEAR(side_of_pages(*file, {.scale = 3}), 3 * 0.04, 1e-6);
}

}  // namespace
}  // namespace thimble::scene
