#include "thimble/scene/scene_file.h"
#include "meshes/object_mesh.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "support/scratch.h"

namespace thimble::scene {
namespace {

const std::filesystem::path kFolder = support::scratch_folder() / "thimble_scene";

// Writes a scene next to an existing arm and mesh. Returns the mistakes.
driver::Result<scene::Scene> scene_from(const std::string& objects, const std::string& path,
                                        const std::string& more = "") {
  std::filesystem::create_directories(kFolder / "meshes");
  std::filesystem::copy_file(
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/arms/vintage_phantom.yaml",
      kFolder / "arm.yaml", std::filesystem::copy_options::overwrite_existing);
  std::ofstream(kFolder / "meshes/ball.off") << "OFF\n";
  std::ofstream(kFolder / "scene.yaml") << "name: test\narm: arm.yaml\nduration: 2\n" + more +
                                               "objects:\n" + objects + "hand:\n  path:\n" + path;
  return scene::load_scene(kFolder / "scene.yaml", {.mesh_folder = kFolder / "meshes"});
}

const std::string kBall = "  - {name: ball, mesh: cgal:ball.off, size: 0.1, stiffness: 500}\n";
const std::string kWait = "    - {t: 0, at: [0, 0, 0.05]}\n";

std::string mistake(const std::string& objects, const std::string& path,
                    const std::string& more = "") {
  const auto scene = scene_from(objects, path, more);
  return scene ? "" : scene.error().message;
}

TEST(SceneFile, ReadsObjectsAndHandPath) {
  const auto scene =
      scene_from(kBall, kWait + "    - {t: 1, on: ball, near: [0, 0, 0.05], press: 0.004}\n");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_EQ(scene->name, "test");
  EXPECT_EQ(scene->rate, 1000);
  EXPECT_EQ(scene->arms.front().arm_file, kFolder / "arm.yaml");
  ASSERT_EQ(scene->objects.size(), 1U);
  EXPECT_EQ(scene->objects[0].mesh_file, kFolder / "meshes/ball.off");
  EXPECT_EQ(scene->objects[0].stiffness, 500);
  ASSERT_EQ(scene->arms.front().hand.size(), 2U);
  EXPECT_FALSE(scene->arms.front().hand[0].on.has_value());
  EXPECT_EQ(scene->arms.front().hand[1].on, "ball");
  EXPECT_EQ(scene->arms.front().hand[1].press, 0.004);
}

TEST(SceneFile, ReadsSeveralObjectsIfTheirNamesDiffer) {
  const auto scene =
      scene_from(kBall + "  - {name: b, mesh: cgal:ball.off, stiffness: 1}\n", kWait);
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_EQ(scene->objects.size(), 2U);
  EXPECT_NE(
      mistake(kBall + kBall, kWait).find("objects: expected different names, found \"ball\" twice"),
      std::string::npos);
  EXPECT_NE(mistake("", kWait).find("objects: expected a list"), std::string::npos);
}

TEST(SceneFile, ReadsContactOrListsTheChoices) {
  const auto scene = scene_from(
      "  - {name: b, mesh: cgal:ball.off, stiffness: 1, contact: {tracker: offset, blending: "
      "phong, normals: round, "
      "curved_depth: true, crease_degrees: 60}}\n",
      kWait);
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_EQ(scene->objects[0].contact.tracker, render::TrackerChoice::kOffset);
  EXPECT_EQ(scene->objects[0].contact.blending, render::BlendingChoice::kPhong);
  EXPECT_EQ(scene->objects[0].contact.normals, render::NormalWeights::kRound);
  EXPECT_EQ(scene->objects[0].contact.curved_depth, true);
  EXPECT_NEAR(scene->objects[0].contact.crease_angle.value(), 1.0471975511965976, 1e-12);
  EXPECT_NE(
      mistake("  - {name: b, mesh: cgal:ball.off, stiffness: 1, contact: {tracker: magic}}\n",
              kWait)
          .find("tracker: expected auto, edge_planes, normal_projection, offset, god_object or "
                "compact, found \"magic\""),
      std::string::npos);
  EXPECT_NE(
      mistake("  - {name: b, mesh: cgal:ball.off, stiffness: 1, contact: {normals: mean}}\n", kWait)
          .find("normals: expected angle, round or fitted, found \"mean\""),
      std::string::npos);
}

TEST(SceneFile, AcceptsAProfileOnlyForBands) {
  const auto with = [](const std::string& contact) {
    return "  - {name: b, mesh: cgal:ball.off, stiffness: 1, contact: {" + contact + "}}\n";
  };
  const auto smooth = scene_from(with("blending: sized_band, profile: smooth"), kWait);
  ASSERT_TRUE(smooth.ok()) << smooth.error().message;
  EXPECT_EQ(smooth->objects[0].contact.profile, render::BlendProfile::kSmooth);
  EXPECT_FALSE(scene_from(with("blending: sized_band"), kWait)->objects[0].contact.profile);
  EXPECT_NE(mistake(with("blending: fixed_band, profile: round"), kWait)
                .find("profile: expected linear or smooth, found \"round\""),
            std::string::npos);
  for (const char* other : {"profile: smooth", "blending: phong, profile: linear"}) {
    EXPECT_NE(mistake(with(other), kWait).find("profile: sets how the normal turns within a band"),
              std::string::npos)
        << other;
  }
}

TEST(SceneFile, CopiedObjectHasItsOwnRareSettings) {
  SceneObject object;
  object.body.dent.emplace().rings = 2;
  SceneObject copy = object;
  copy.body.dent->rings = 3;
  EXPECT_EQ(object.body.dent->rings, 2);
  EXPECT_EQ(std::optional<render::DentSettings>(object.body.dent)->rings, 2);
  copy = object;
  EXPECT_EQ(copy.body.dent->rings, 2);
  copy = SceneObject{};
  EXPECT_FALSE(copy.body.dent.has_value());
  EXPECT_FALSE(std::optional<render::DentSettings>(copy.body.dent).has_value());
  EXPECT_TRUE(object.body.dent.has_value());
}

// A scene may have 100,000 shapes, most of them without a body or maps.
TEST(SceneFile, ObjectWithoutRareSettingsIsSmall) {
  EXPECT_LE(sizeof(SceneObject), 720u);
}

TEST(SceneFile, ReadsDentsAndReportsMistakes) {
  const auto with = [](const std::string& dent) {
    return "  - {name: b, mesh: cgal:ball.off, stiffness: 1, body: {dent: {" + dent + "}}}\n";
  };
  const auto plain = scene_from(with(""), kWait);
  ASSERT_TRUE(plain.ok()) << plain.error().message;
  ASSERT_TRUE(plain->objects[0].body.dent);
  EXPECT_EQ(plain->objects[0].body.dent->step, 1e-3);
  EXPECT_EQ(plain->objects[0].body.dent->integrator, render::kDefaultScheme);
  EXPECT_FALSE(scene_from("  - {name: b, mesh: cgal:ball.off, stiffness: 1}\n", kWait)
                   ->objects[0]
                   .body.dent);
  const auto full = scene_from(
      with("mass: 0.002, stiffness: 30, rings: 2, integrator: verlet, pull: 0.5"), kWait);
  ASSERT_TRUE(full.ok()) << full.error().message;
  const render::DentSettings& dent = *full->objects[0].body.dent;
  EXPECT_EQ(dent.mass, 0.002);
  EXPECT_EQ(dent.rings, 2);
  EXPECT_EQ(dent.integrator, render::SpringScheme::kVerlet);
  for (const auto& [wrong, said] : std::vector<std::pair<std::string, std::string>>{
           {"mass: 0", "mass: expected a number"},
           {"mass: -1", "mass: expected a number"},
           {"mass: .nan", "mass: expected a"},
           {"stiffness: 1e12", "stiffness: expected a number"},
           {"stiffness: 0", "stiffness: expected a number"},
           {"pull: 2", "pull: expected a number"},
           {"rings: 1.5", "rings: expected a whole number"},
           {"region: whole, rings: 2", "rings: cannot be combined with region: whole"},
           {"integrator: explicit_euler", "integrator: expected symplectic_euler"},
           {"stifness: 3", "did you mean \"stiffness\"?"}}) {
    EXPECT_NE(mistake(with(wrong), kWait).find(said), std::string::npos)
        << mistake(with(wrong), kWait);
  }
  EXPECT_NE(
      mistake("  - {name: b, sphere: {radius: 0.02}, stiffness: 1, body: {dent: {}}}\n", kWait)
          .find("body: of a shape can only be motion"),
      std::string::npos);
}

TEST(SceneFile, ReportsAMissingMeshOrArm) {
  EXPECT_NE(mistake("  - {name: b, mesh: cgal:cube.off, stiffness: 1}\n", kWait)
                .find("scene.yaml:5: mesh: expected a file, found none at"),
            std::string::npos);
  EXPECT_NE(mistake("  - {name: b, mesh: cube.off, stiffness: 1}\n", kWait)
                .find((kFolder / "cube.off").string()),
            std::string::npos);
}

TEST(SceneFile, PrefersAnArmFileNextToTheSceneToAName) {
  ASSERT_TRUE(scene_from(kBall, kWait));  // writes the mesh
  std::filesystem::remove(kFolder / "falcon");
  const auto with_arm = [](const std::string& arm) {
    std::ofstream(kFolder / "named.yaml") << "name: test\narm: " + arm +
                                                 "\nduration: 2\nobjects:\n" + kBall +
                                                 "hand:\n  path:\n" + kWait;
    return scene::load_scene(kFolder / "named.yaml", {.mesh_folder = kFolder / "meshes"});
  };
  for (const std::string name : {"falcon", "falcon.yaml"}) {
    const auto named = with_arm(name);
    ASSERT_TRUE(named.ok()) << named.error().message;
    EXPECT_EQ(named->arms.front().arm_file.filename(), "falcon.yaml");
    EXPECT_EQ(named->arms.front().own_arm_file, named->arms.front().arm_file);
  }
  std::filesystem::copy_file(kFolder / "arm.yaml", kFolder / "falcon");
  EXPECT_EQ(with_arm("falcon")->arms.front().arm_file, kFolder / "falcon");
  std::filesystem::remove(kFolder / "falcon");
  const auto unknown = with_arm("eagle");
  ASSERT_FALSE(unknown.ok());
  EXPECT_NE(unknown.error().message.find("named.yaml:2: arm: expected a file, found none at"),
            std::string::npos);
  EXPECT_NE(unknown.error().message.find("the name of an arm: falcon, "), std::string::npos)
      << unknown.error().message;
  // A name with a folder is a path.
  EXPECT_EQ(with_arm("arms/falcon.yaml").error().message.find("the name of an arm"),
            std::string::npos);
}

TEST(SceneFile, RefusesSizeTogetherWithScale) {
  EXPECT_NE(mistake("  - {name: b, mesh: cgal:ball.off, size: 1, scale: 1, stiffness: 1}\n", kWait)
                .find("scale: cannot be used with size"),
            std::string::npos);
}

TEST(SceneFile, RejectsWaypointsNeitherFreeNorOnAnObject) {
  EXPECT_NE(mistake(kBall, "    - {t: 0}\n").find("expected either at"), std::string::npos);
  EXPECT_NE(mistake(kBall, "    - {t: 0, on: cube, near: [0, 0, 0]}\n")
                .find("on: expected an object of this scene, found \"cube\""),
            std::string::npos);
  EXPECT_NE(mistake(kBall, kWait + kWait).find("t: expected a later time"), std::string::npos);
}

TEST(SceneFile, OverridesTheEnergyStageOfTheArm) {
  const auto own = scene_from(kBall, kWait),
             none = scene_from(kBall, kWait, "gate: {energy: none}\n");
  ASSERT_TRUE(own.ok());
  ASSERT_TRUE(none.ok());
  EXPECT_FALSE(own->energy.has_value());
  EXPECT_EQ(none->energy, driver::EnergyStage::kNone);
  EXPECT_NE(mistake(kBall, kWait, "gate: {force_max: 9}\n").find("force_max"), std::string::npos);
}

TEST(SceneFile, RejectsARateBelowTheStallLimit) {
  EXPECT_EQ(mistake(kBall, kWait, "rate: 50\n"), "");  // `stall` of the arm is 20 ms
  for (const char* rate : {"rate: 49.9\n", "rate: 40\n"}) {
    EXPECT_NE(
        mistake(kBall, kWait, rate).find("scene.yaml:4: rate: expected 50 Hz or more, found "),
        std::string::npos)
        << mistake(kBall, kWait, rate);
  }
}

TEST(SceneFile, GivesTheRadiusOfTheTipToAllSurfaces) {
  const auto scene = scene_from(kBall + "  - {name: s, sphere: {radius: 0.02}, stiffness: 1}\n",
                                kWait, "tool: {radius: 0.004}\n");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_EQ(scene->tip_radius, 0.004);
  EXPECT_EQ(scene->objects[0].contact.tip_radius, 0.004);
  EXPECT_EQ(scene->objects[1].contact.tip_radius, 0.004);
  const auto point = scene_from(kBall, kWait, "tool: {radius: 0}\n");
  ASSERT_TRUE(point.ok()) << point.error().message;
  EXPECT_EQ(point->objects[0].contact, render::ContactChoice());
}

TEST(SceneFile, LiftsAHandOnASurfaceByTheRadiusOfTheTip) {
  const auto scene =
      scene_from(kBall, kWait + "    - {t: 1, on: ball, near: [0, 0, 0.05], press: 0.001}\n",
                 "tool: {radius: 0.004}\n");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_EQ(scene->arms.front().hand[0].press, 0);
  EXPECT_DOUBLE_EQ(scene->arms.front().hand[1].press, 0.001 - 0.004);
}

TEST(SceneFile, RefusesATipWithARadiusWhereOnlyAPointCanTouch) {
  const std::string mesh = "  - {name: b, mesh: cgal:ball.off, size: 0.1, stiffness: 500, ";
  const std::string motion = "body: {motion: {mass: 0.1, hold: 300}}}\n";
  EXPECT_TRUE(scene_from(mesh + motion, kWait).ok());
  EXPECT_NE(mistake(mesh + motion, kWait, "tool: {radius: 0.004}\n").find("can be held"),
            std::string::npos);
  EXPECT_NE(mistake(kBall, kWait, "tool: {radius: 4}\n").find("radius"), std::string::npos);
  EXPECT_NE(mistake(kBall, kWait, "tool: {radius: 1e-6}\n").find("expected 0, a point, or 1e-05 m"),
            std::string::npos);
  EXPECT_NE(mistake(kBall, kWait, "tool: {radius: -0.001}\n").find("radius"), std::string::npos);
}

TEST(SceneFile, RefusesUnknownKeys) {
  EXPECT_NE(mistake(kBall, kWait, "rait: 1000\n").find("did you mean \"rate\"?"),
            std::string::npos);
}

TEST(SceneFile, ReadsRepairAndSheets) {
  const std::string mesh = "  - {name: ball, mesh: cgal:ball.off, size: 0.1, stiffness: 500, ";
  const auto scene = scene_from(mesh + "repair: true, open: {thickness: 0.001}}\n", kWait);
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  EXPECT_TRUE(scene->objects[0].repair);
  EXPECT_EQ(scene->objects[0].sheet_thickness, 0.001);
  EXPECT_EQ(scene->objects[0].contact.tracker, render::TrackerChoice::kGodObject);
  const auto plain = scene_from(kBall, kWait);
  EXPECT_FALSE(plain->objects[0].repair);
  EXPECT_FALSE(plain->objects[0].sheet_thickness);
  EXPECT_NE(mistake(mesh + "open: {thickness: 0.001}, contact: {tracker: offset}}\n", kWait)
                .find("cannot pass through a sheet"),
            std::string::npos);
  EXPECT_NE(mistake(mesh + "open: {thickness: 0.5}}\n", kWait).find("thickness"),
            std::string::npos);
  EXPECT_NE(mistake(mesh + "open: {}}\n", kWait).find("thickness"), std::string::npos);
  EXPECT_NE(mistake(mesh + "open: {thickness: 0.001}, body: {dent: {}}}\n", kWait)
                .find("dent, plastic and snap need a closed mesh"),
            std::string::npos);
}

TEST(PlaceMesh, GivesTheBoxItsSizeAndCentre) {
  render::TriangleMesh mesh;
  mesh.vertices = {{10, 0, 0}, {14, 1, 0}, {10, 2, 3}};
  mesh.triangles = {{0, 1, 2}};
  scene::SceneObject object;
  object.size = 0.1;
  object.p_WO = {0.01, 0.02, 0.03};
  object.R_WO = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const render::TriangleMesh placed = scene::place_mesh(mesh, object);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : placed.vertices) box.extend(vertex);
  EXPECT_LT((box.center() - object.p_WO).norm(), 1e-15);
  const double scale = 0.1 / 4;  // the box of the file is 4 x 2 x 3
  for (std::size_t i = 0; i < 3; ++i) {
    const double before = (mesh.vertices[i] - mesh.vertices[(i + 1) % 3]).norm();
    const double after = (placed.vertices[i] - placed.vertices[(i + 1) % 3]).norm();
    EXPECT_NEAR(after, scale * before, 1e-15);
  }
}

TEST(SceneFile, ReadsShapesAndFields) {
  const auto scene = scene_from(
      "  - {name: wall, plane: {normal: [0, 2, 0]}, position: [0, 0.01, 0], stiffness: 500}\n"
      "  - {name: ball, sphere: {radius: 0.02}, stiffness: 400, damping: 1, effects: [{texture: "
      "sandpaper, wavelength: 0.003}]}\n"
      "  - {name: block, box: {sides: [0.01, 0.02, 0.03]}, rotate_degrees: [[z, 90]], stiffness: "
      "300}\n"
      "  - {name: split, box: {sides: [0.01, 0.02, 0.03], form: wedges}, stiffness: 300}\n"
      "  - {name: weight, field: gravity, mass: 0.1}\n",
      kWait + "    - {t: 1, on: ball, near: [0, 0, 0.05], press: 0.004}\n");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  ASSERT_EQ(scene->objects.size(), 5U);
  const auto& wall = std::get<render::HalfSpace>(scene->objects[0].shape->shape_W);
  EXPECT_EQ(wall.n_W, Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(wall.p_WO, Eigen::Vector3d(0, 0.01, 0));
  EXPECT_EQ(std::get<render::Sphere>(scene->objects[1].shape->shape_W).radius, 0.02);
  EXPECT_EQ(scene->objects[1].effects.size(), 1U);
  const auto& block = std::get<render::EntryFaceBox>(scene->objects[2].shape->shape_W);
  EXPECT_EQ(block.half_sides, Eigen::Vector3d(0.005, 0.01, 0.015));
  EXPECT_TRUE(block.inside({0.009, 0, 0}));  // rotated: its longer side is along x
  EXPECT_TRUE(std::holds_alternative<render::WedgeBox>(scene->objects[3].shape->shape_W));
  EXPECT_FALSE(scene->objects[4].shape.has_value());
  driver::DeviceState state;
  EXPECT_NEAR(scene->objects[4].build_field()->update(state).f_T_W.z(), -0.980665, 1e-12);
}

TEST(SceneFile, ReadsRoundShapes) {
  const auto scene = scene_from(
      "  - {name: can, cylinder: {radius: 0.02, height: 0.05}, position: [0.01, 0, 0], "
      "rotate_degrees: [[x, 90]], stiffness: 3}\n"
      "  - {name: pill, capsule: {radius: 0.02, height: 0.05}, stiffness: 3}\n"
      "  - {name: hat, cone: {radius: 0.02, height: 0.05}, stiffness: 3}\n"
      "  - {name: ring, torus: {radius: 0.02, tube: 0.005}, stiffness: 3}\n",
      kWait);
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  const auto shape = [&](std::size_t i) { return scene->objects[i].shape->shape_W; };
  const auto can = std::get<render::Cylinder>(shape(0));
  EXPECT_TRUE(can.inside({0.029, 0.024, 0}));  // along y
  EXPECT_FALSE(can.inside({0.01, 0, 0.024}));
  EXPECT_TRUE(std::get<render::Capsule>(shape(1)).inside({0, 0, 0.044}));
  const auto hat = std::get<render::Cone>(shape(2));
  EXPECT_TRUE(hat.inside({0, 0, 0.024}));
  EXPECT_FALSE(hat.inside({0.015, 0, 0.024}));
  EXPECT_TRUE(hat.inside({0.015, 0, -0.024}));
  const auto ring = std::get<render::Torus>(shape(3));
  EXPECT_TRUE(ring.inside({0, 0.024, 0}));
  EXPECT_FALSE(ring.inside({0, 0, 0}));
}

TEST(SceneFile, DrawsShapesWhereTheyAre) {
  const auto scene = scene_from(
      "  - {name: ball, sphere: {radius: 0.02}, position: [0.01, 0, 0], stiffness: 400}\n"
      "  - {name: block, box: {sides: [0.01, 0.02, 0.03]}, rotate_degrees: [[x, 30]], stiffness: "
      "3}\n"
      "  - {name: wall, plane: {normal: [1, 1, 0], drawn_side: 0.2}, stiffness: 400}\n"
      "  - {name: can, cylinder: {radius: 0.02, height: 0.05}, rotate_degrees: [[x, 30]], "
      "stiffness: 3}\n"
      "  - {name: pill, capsule: {radius: 0.02, height: 0.05}, rotate_degrees: [[x, 30]], "
      "stiffness: 3}\n"
      "  - {name: hat, cone: {radius: 0.02, height: 0.05}, rotate_degrees: [[x, 30]], stiffness: "
      "3}\n"
      "  - {name: ring, torus: {radius: 0.02, tube: 0.005}, rotate_degrees: [[x, 30]], stiffness: "
      "3}\n",
      kWait);
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  constexpr double kPi = 3.14159265358979;
  const std::map<std::string, double> volumes{{"can", kPi * 4e-4 * 0.05},
                                              {"pill", kPi * 4e-4 * 0.05 + 4.0 / 3 * kPi * 8e-6},
                                              {"hat", kPi * 4e-4 * 0.05 / 3},
                                              {"ring", 2 * kPi * 0.02 * kPi * 2.5e-5}};
  for (const scene::SceneObject& object : scene->objects) {
    const render::TriangleMesh mesh = object.shape->mesh_W();
    ASSERT_FALSE(mesh.triangles.empty());
    double volume = 0;
    for (const auto& t : mesh.triangles) {
      const auto v = [&](std::size_t k) { return mesh.vertices[static_cast<std::size_t>(t[k])]; };
      volume += (v(0) - object.p_WO).dot((v(1) - object.p_WO).cross(v(2) - object.p_WO)) / 6;
    }
    for (const auto& vertex : mesh.vertices) {
      const auto place = std::visit(
          [&](const auto& shape) {
            if constexpr (requires { shape.place(vertex, vertex); }) {
              return shape.place(vertex, vertex).depth;
            } else if constexpr (requires { shape.kSide; }) {
              // On one face, and below no other.
              double least = std::abs(shape.on_face(vertex, 0, vertex).depth);
              for (std::int32_t face = 1; face <= shape.kSide; ++face) {
                least = std::min(least, std::abs(shape.on_face(vertex, face, vertex).depth));
              }
              return least;
            } else {
              return render::WedgeBox{shape}.place(vertex, vertex).depth;
            }
          },
          object.shape->shape_W);
      EXPECT_NEAR(place, 0, 1e-15) << object.name;
    }
    // Oriented outwards: volumes are positive (zero for a flat patch).
    if (object.name == "ball") {
      EXPECT_NEAR(volume, 4.0 / 3 * 3.14159265 * 8e-6, 1e-7);
    }
    if (object.name == "block") {
      EXPECT_NEAR(volume, 6e-6, 1e-15);
    }
    if (const auto known = volumes.find(object.name); known != volumes.end()) {
      EXPECT_NEAR(volume, known->second, 4e-3 * known->second) << object.name;
      EXPECT_LT(volume, known->second) << object.name;
    }
  }
}

TEST(SceneFile, ReportsMistakesInShapesAndFields) {
  const auto wrong = [](const std::string& object) {
    return mistake("  - {name: a, " + object + "}\n", kWait);
  };
  EXPECT_NE(wrong("sphere: {radius: -1}, stiffness: 1").find("radius"), std::string::npos);
  EXPECT_NE(wrong("sphere: {radius: .nan}, stiffness: 1").find("radius"), std::string::npos);
  EXPECT_NE(wrong("sphere: {radius: 0.1, sides: 2}, stiffness: 1").find("sides"),
            std::string::npos);
  EXPECT_NE(wrong("plane: {normal: [0, 0, 0]}, stiffness: 1").find("expected a direction"),
            std::string::npos);
  EXPECT_NE(wrong("box: {sides: [0.1, 0, 0.1]}, stiffness: 1").find("sides"), std::string::npos);
  EXPECT_NE(wrong("box: {sides: [0.1, 0.1, 0.1], form: round}, stiffness: 1").find("form"),
            std::string::npos);
  EXPECT_NE(wrong("sphere: {radius: 0.1}").find("stiffness"), std::string::npos);
  EXPECT_NE(
      wrong("sphere: {radius: 0.1}, stiffness: 1, contact: {tracker: offset}").find("contact"),
      std::string::npos);
  EXPECT_NE(wrong("sphere: {radius: 0.1}, plane: {}, stiffness: 1").find("found several"),
            std::string::npos);
  for (const char* shape : {"cylinder", "capsule", "cone"}) {
    const std::string name = shape;
    EXPECT_NE(wrong(name + ": {radius: 0.1}, stiffness: 1").find("height: is missing"),
              std::string::npos);
    EXPECT_NE(wrong(name + ": {radius: 0, height: 0.1}, stiffness: 1").find("radius"),
              std::string::npos);
    EXPECT_NE(wrong(name + ": {radius: 0.1, height: 0.1}, box: {sides: [1, 1, 1]}, stiffness: 1")
                  .find("found several"),
              std::string::npos);
  }
  EXPECT_NE(wrong("torus: {radius: 0.01, tube: 0.01}, stiffness: 1").find("less than radius"),
            std::string::npos);
  EXPECT_NE(wrong("field: magic").find("field"), std::string::npos);
  EXPECT_NE(wrong("field: gravity").find("mass"), std::string::npos);
  EXPECT_NE(wrong("field: gravity, mass: 0.1, stiffness: 3").find("stiffness"), std::string::npos);
  EXPECT_NE(wrong("field: viscous, damping: 500").find("oscillates above"), std::string::npos);
  EXPECT_NE(mistake("  - {name: a, field: gravity, mass: 0.1}\n",
                    kWait + "    - {t: 1, on: a, near: [0, 0, 0]}\n")
                .find("a field has no surface"),
            std::string::npos);
  EXPECT_NE(wrong("sphere: {radius: 0.1}, stiffness: 800, effects: [{texture: sines, waves: "
                  "[{amplitude: 0.004, wavelength: 0.1}]}]")
                .find("5 N press only 6.25 mm deep"),
            std::string::npos);
}

TEST(SceneFile, AcceptsEachNumberOfTheGripUpToItsLimitsOnly) {
  struct Limits {
    const char* key;
    double max;
  };
  for (const Limits& limits : {Limits{"mass", 10}, Limits{"stiffness", 1e5},
                               Limits{"damping", 1000}, Limits{"tremor", 0.01}}) {
    const auto found = [&limits](double value) {
      std::ostringstream grip;
      grip.precision(12);
      grip << "  grip: {" << limits.key << ": " << value << "}\n";
      return mistake("  - {name: ball, sphere: {radius: 0.01}, stiffness: 500}\n",
                     kWait + grip.str());
    };
    const std::string expected = std::string(limits.key) + ": expected a number from 0 to ";
    EXPECT_EQ(found(0), "") << limits.key;
    EXPECT_EQ(found(limits.max), "") << limits.key;
    EXPECT_NE(found(-1e-6 * limits.max).find(expected), std::string::npos) << limits.key;
    EXPECT_NE(found(limits.max * (1 + 1e-6)).find(expected), std::string::npos) << limits.key;
  }
}

}  // namespace
}  // namespace thimble::scene
