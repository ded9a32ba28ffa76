#include "meshes/object_mesh.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "support/scratch.h"
#include "thimble/render/mesh/check_mesh.h"
#include "thimble/scene/scene_objects.h"

namespace thimble::scene {
namespace {

using Eigen::Vector3d;

// A cube of side 1 without its upper face; without more faces, a sheet.
std::filesystem::path write_cube(const std::string& name, int faces) {
  const std::filesystem::path file = support::scratch_folder() / name;
  std::ofstream out(file);
  out << "OFF\n8 " << faces << " 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n";
  const char* const sides[] = {"4 3 2 1 0", "4 0 1 5 4", "4 1 2 6 5",
                               "4 2 3 7 6", "4 3 0 4 7", "4 4 5 6 7"};
  for (int i = 0; i < faces; ++i) out << sides[i] << '\n';
  return file;
}

scene::SceneObject object_of(const std::filesystem::path& file) {
  scene::SceneObject object;
  object.name = "thing";
  object.mesh_file = file;
  object.size = 0.06;
  object.stiffness = 500;
  return object;
}

TEST(ObjectMesh, IsUnchangedWithoutRepair) {
  scene::SceneObject object = object_of(write_cube("no_lid.off", 5));
  const auto open = scene::load_object_mesh(object);
  ASSERT_TRUE(open.ok()) << open.error().message;
  EXPECT_FALSE(render::check_mesh(open->mesh_W).touchable());
  EXPECT_TRUE(open->notes.empty());
  object.repair = true;
  const auto repaired = scene::load_object_mesh(object);
  ASSERT_TRUE(repaired.ok());
  const render::MeshFindings found = render::check_mesh(repaired->mesh_W);
  EXPECT_TRUE(found.touchable());
  EXPECT_NEAR(found.volume, 0.06 * 0.06 * 0.06, 1e-12);
  ASSERT_EQ(repaired->notes.size(), 1u);
  EXPECT_NE(repaired->notes[0].find("no_lid.off: 1 hole was filled"), std::string::npos)
      << repaired->notes[0];
}

TEST(ObjectMesh, ThickensSheetsToTheirThicknessInTheWorld) {
  scene::SceneObject object = object_of(write_cube("two_sides.off", 2));
  object.repair = true;  // has no effect on this mesh
  object.sheet_thickness = 0.001;
  const auto sheet = scene::load_object_mesh(object);
  ASSERT_TRUE(sheet.ok()) << sheet.error().message;
  const render::MeshFindings found = render::check_mesh(sheet->mesh_W);
  EXPECT_TRUE(found.touchable());
  EXPECT_NEAR(found.volume, 2 * 0.06 * 0.06 * 0.001, 0.1 * 2 * 0.06 * 0.06 * 0.001);
  EXPECT_NE(sheet->notes.back().find("not closed and treated as a sheet"), std::string::npos);
}

TEST(ObjectMesh, UsesTheUnitOfItsFileUnlessTheSceneSetsOne) {
  scene::SceneObject object;
  object.mesh_file = std::filesystem::path(THIMBLE_SOURCE_DIR) / "tests/data/meshes/box.3mf";
  EXPECT_DOUBLE_EQ(scene::load_object_mesh(object)->place.scale, 0.0254);
  object.scale = 0.01;
  EXPECT_DOUBLE_EQ(scene::load_object_mesh(object)->place.scale, 0.01);
  object.scale = {};
  object.size = 0.3;
  EXPECT_DOUBLE_EQ(scene::load_object_mesh(object)->place.scale, 0.1);
}

// A hand presses 20 mm deep into the middle of a sheet of 1 mm, from above and from below.
TEST(ObjectMesh, SheetHoldsTheTipFromBothSides) {
  scene::Scene scene;
  scene.rate = 1000;
  scene.objects.push_back(object_of(write_cube("one_side.off", 1)));
  scene.objects[0].sheet_thickness = 0.001;
  scene.objects[0].contact.tracker = render::TrackerChoice::kGodObject;
  for (const double side : {1.0, -1.0}) {
    const auto objects = scene::SceneObjects::build(scene);
    ASSERT_TRUE(objects.ok()) << objects.error().message;
    driver::DeviceState state;
    state.dt = 1e-3;
    state.fresh = true;
    double last = 0;
    for (int i = 0; i <= 40; ++i) {
      ++state.tick;
      state.p_WT = Vector3d(0.002, 0.003, side * (0.02 - 0.001 * i));
      const driver::ForceCommand command = (*objects)->touch()(state);
      const double depth = 0.0005 - 0.02 + 0.001 * i;
      if (depth < 0) {
        EXPECT_EQ(command.f_T_W.norm(), 0) << i;
        continue;
      }
      EXPECT_GT(side * command.f_T_W.z(), 0.9 * 500 * depth) << i;
      EXPECT_GE(side * command.f_T_W.z(), last) << i;
      last = side * command.f_T_W.z();
    }
    EXPECT_GT(last, 9);
  }
}

TEST(ObjectMesh, OpenMeshErrorNamesTheRemedy) {
  scene::Scene scene;
  scene.rate = 1000;
  scene.objects.push_back(object_of(write_cube("no_corner.off", 3)));
  const auto open = scene::SceneObjects::build(scene);
  ASSERT_FALSE(open.ok());
  EXPECT_NE(open.error().message.find("Set repair: true"), std::string::npos)
      << open.error().message;
  scene.objects[0].repair = true;
  const auto still_open = scene::SceneObjects::build(scene);
  ASSERT_FALSE(still_open.ok());
  EXPECT_NE(still_open.error().message.find("Set open: {thickness: 0.001} as well"),
            std::string::npos)
      << still_open.error().message;
  scene.objects[0].sheet_thickness = 0.001;
  scene.objects[0].contact.tracker = render::TrackerChoice::kGodObject;
  EXPECT_TRUE(scene::SceneObjects::build(scene).ok());
}

TEST(ObjectMesh, IsAnErrorIfNoTriangleIsLeft) {
  const std::filesystem::path file = support::scratch_folder() / "line.off";
  std::ofstream(file) << "OFF\n3 1 0\n0 0 0\n1 0 0\n2 0 0\n3 0 1 2\n";
  scene::SceneObject object = object_of(file);
  object.sheet_thickness = 0.001;
  const auto mesh = scene::load_object_mesh(object);
  ASSERT_FALSE(mesh.ok());
  EXPECT_NE(mesh.error().message.find("no triangle has an area"), std::string::npos);
}

}  // namespace
}  // namespace thimble::scene
