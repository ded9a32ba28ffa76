#include "scene_file.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>
#include <string>

#include "support/scratch.h"

namespace thimble::app {
namespace {

const std::filesystem::path kFolder = support::scratch_folder() / "thimble_scene";

// Writes a scene beside an arm and a mesh that exist, and tells what was wrong with it.
driver::Result<Scene> read(const std::string& objects, const std::string& path,
                           const std::string& more = "") {
  std::filesystem::create_directories(kFolder / "meshes");
  std::filesystem::copy_file(
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml",
      kFolder / "arm.yaml", std::filesystem::copy_options::overwrite_existing);
  std::ofstream(kFolder / "meshes/ball.off") << "OFF\n";
  std::ofstream(kFolder / "scene.yaml") << "name: test\narm: arm.yaml\nduration: 2\n" + more +
                                               "objects:\n" + objects + "hand:\n  path:\n" + path;
  return read_scene(kFolder / "scene.yaml", kFolder / "meshes");
}

const std::string kBall = "  - {name: ball, mesh: cgal:ball.off, size: 0.1, stiffness: 500}\n";
const std::string kWait = "    - {t: 0, at: [0, 0, 0.05]}\n";

std::string mistake(const std::string& objects, const std::string& path,
                    const std::string& more = "") {
  const auto scene = read(objects, path, more);
  return scene ? "" : scene.error().message;
}

TEST(SceneFile, ReadsObjectsAndTheHandsWay) {
  const auto scene =
      read(kBall, kWait + "    - {t: 1, on: ball, near: [0, 0, 0.05], press: 0.004}\n");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_EQ(scene->name, "test");
  EXPECT_EQ(scene->rate, 1000);
  EXPECT_EQ(scene->arm_file, kFolder / "arm.yaml");
  ASSERT_EQ(scene->objects.size(), 1U);
  EXPECT_EQ(scene->objects[0].mesh_file, kFolder / "meshes/ball.off");
  EXPECT_EQ(scene->objects[0].stiffness, 500);
  ASSERT_EQ(scene->hand.size(), 2U);
  EXPECT_FALSE(scene->hand[0].on.has_value());
  EXPECT_EQ(scene->hand[1].on, "ball");
  EXPECT_EQ(scene->hand[1].press, 0.004);
}

TEST(SceneFile, ReadsSeveralObjectsIfTheirNamesDiffer) {
  const auto scene = read(kBall + "  - {name: b, mesh: cgal:ball.off, stiffness: 1}\n", kWait);
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_EQ(scene->objects.size(), 2U);
  EXPECT_NE(
      mistake(kBall + kBall, kWait).find("objects: expected different names, found \"ball\" twice"),
      std::string::npos);
  EXPECT_NE(mistake("", kWait).find("objects: expected a list"), std::string::npos);
}

TEST(SceneFile, NamesTheWayOfContactOrSaysWhichThereAre) {
  const auto scene = read(
      "  - {name: b, mesh: cgal:ball.off, stiffness: 1, contact: {tracker: offset, blending: "
      "phong, "
      "curved_depth: true, crease_degrees: 60}}\n",
      kWait);
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_EQ(scene->objects[0].contact.tracker, render::TrackerChoice::kOffset);
  EXPECT_EQ(scene->objects[0].contact.blending, render::BlendingChoice::kPhong);
  EXPECT_EQ(scene->objects[0].contact.curved_depth, true);
  EXPECT_NEAR(scene->objects[0].contact.crease_angle.value(), 1.0471975511965976, 1e-12);
  EXPECT_NE(mistake("  - {name: b, mesh: cgal:ball.off, stiffness: 1, contact: {tracker: magic}}\n",
                    kWait)
                .find("tracker: expected edge_planes, normal_projection, offset, god_object or "
                      "compact, found \"magic\""),
            std::string::npos);
}

TEST(SceneFile, NamesAMeshOrArmThatIsNotThere) {
  EXPECT_NE(mistake("  - {name: b, mesh: cgal:cube.off, stiffness: 1}\n", kWait)
                .find("scene.yaml:5: mesh: expected a file, found none at"),
            std::string::npos);
  EXPECT_NE(mistake("  - {name: b, mesh: cube.off, stiffness: 1}\n", kWait)
                .find((kFolder / "cube.off").string()),
            std::string::npos);
}

TEST(SceneFile, RefusesSizeTogetherWithScale) {
  EXPECT_NE(mistake("  - {name: b, mesh: cgal:ball.off, size: 1, scale: 1, stiffness: 1}\n", kWait)
                .find("scale: cannot stand together with size"),
            std::string::npos);
}

TEST(SceneFile, RefusesStationsThatAreNeitherFreeNorOnAnObject) {
  EXPECT_NE(mistake(kBall, "    - {t: 0}\n").find("expected either at"), std::string::npos);
  EXPECT_NE(mistake(kBall, "    - {t: 0, on: cube, near: [0, 0, 0]}\n")
                .find("on: expected an object of this scene, found \"cube\""),
            std::string::npos);
  EXPECT_NE(mistake(kBall, kWait + kWait).find("t: expected a time after"), std::string::npos);
}

TEST(SceneFile, RefusesUnknownKeys) {
  EXPECT_NE(mistake(kBall, kWait, "rait: 1000\n").find("perhaps \"rate\" was meant"),
            std::string::npos);
}

TEST(PlaceMesh, GivesTheBoxItsSizeAndCentre) {
  render::TriangleMesh mesh;
  mesh.vertices = {{10, 0, 0}, {14, 1, 0}, {10, 2, 3}};
  mesh.triangles = {{0, 1, 2}};
  SceneObject object;
  object.size = 0.1;
  object.p_WO = {0.01, 0.02, 0.03};
  object.R_WO = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const render::TriangleMesh placed = place_mesh(mesh, object);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : placed.vertices) box.extend(vertex);
  EXPECT_LT((box.center() - object.p_WO).norm(), 1e-15);
  const double scale = 0.1 / 4;  // the file's box is 4 x 2 x 3
  for (std::size_t i = 0; i < 3; ++i) {
    const double before = (mesh.vertices[i] - mesh.vertices[(i + 1) % 3]).norm();
    const double after = (placed.vertices[i] - placed.vertices[(i + 1) % 3]).norm();
    EXPECT_NEAR(after, scale * before, 1e-15);
  }
}

}  // namespace
}  // namespace thimble::app
