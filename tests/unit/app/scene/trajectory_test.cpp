#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "meshes/object_mesh.h"
#include "recording/replay_trajectory.h"
#include "recording/trajectory_file.h"
#include "support/scratch.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/scene/scene_file.h"

namespace thimble::scene {
namespace {

std::filesystem::path file_of(const std::string& text) {
  const auto path = support::scratch_folder() / "probe.traj";
  std::ofstream(path) << text;
  return path;
}

TEST(Trajectory, ReadsColumnsInAnyOrderAndUnit) {
  const auto read = session::read_trajectory(
      file_of("number time x y z force\n# a remark\n1, 0, 10, 20, 30, 1, 2, "
              "3\n\n2\t500 11 21 31 4 5 6 7\n"),
      {.columns = "- t z y x fx fy fz", .metres = 1e-3, .seconds = 1e-3});
  ASSERT_TRUE(read) << read.error().message;
  ASSERT_EQ(read->size(), 2u);
  EXPECT_EQ((*read)[0].p, Eigen::Vector3d(0.030, 0.020, 0.010));
  EXPECT_EQ((*read)[1].time, 0.5);
  EXPECT_EQ((*read)[1].f, Eigen::Vector3d(4, 5, 6));
  std::size_t hint = 0;
  EXPECT_NEAR(session::trajectory_at(*read, 0.25, hint).p.x(), 0.0305, 1e-12);
  EXPECT_EQ(session::trajectory_at(*read, 9, hint).p, (*read)[1].p);
  EXPECT_EQ(session::trajectory_at(*read, -1, hint).p, (*read)[0].p);
}

TEST(Trajectory, AnyHintGivesTheSamePoint) {
  const std::vector<session::TrajectoryPoint> points{{.time = 0, .p = {0, 0, 0}},
                                                     {.time = 1, .p = {1, 0, 0}},
                                                     {.time = 2, .p = {1, 4, 0}},
                                                     {.time = 3, .p = {1, 4, 9}}};
  for (std::size_t from = 0; from < 6; ++from) {
    for (const double time : {0.5, 1.0, 1.5, 2.5}) {
      std::size_t hint = from, none = 0;
      EXPECT_EQ(session::trajectory_at(points, time, hint).p,
                session::trajectory_at(points, time, none).p)
          << from << ", " << time;
    }
  }
}

TEST(Trajectory, ErrorsNameLineAndRemedy) {
  const auto mistake = [](const std::string& text, const session::TrajectoryForm& form = {}) {
    const auto read = session::read_trajectory(file_of(text), form);
    return read ? "" : read.error().message;
  };
  EXPECT_NE(mistake("0 0 0 0\n1 0 0\n").find("line 2: expected 4 columns"), std::string::npos);
  EXPECT_NE(mistake("0 0 0 0\n1 0 x 0\n").find("line 2: expected only numbers"), std::string::npos);
  EXPECT_NE(mistake("1 0 0 0\n0 0 0 0\n").find("the time decreases"), std::string::npos);
  EXPECT_NE(mistake("0 0 0 0\n1 99 0 0\n").find("--length"), std::string::npos);
  for (const char* line : {"1 nan 0 0", "1 0 nan 0", "1 0 0 nan", "1 0 0 inf"}) {
    const std::string message = mistake("0 0 0 0\n" + std::string(line) + "\n2 0 0 0\n");
    EXPECT_NE(message.find("line 2: a position or force is not a finite number"), std::string::npos)
        << line << " -> " << message;
  }
  for (const char* line : {"nan 0 0 0", "inf 0 0 0"}) {
    const std::string message = mistake("0 0 0 0\n" + std::string(line) + "\n2 0 0 0\n");
    EXPECT_NE(message.find("line 2: the time is not a finite number"), std::string::npos)
        << line << " -> " << message;
  }
  EXPECT_NE(mistake("0 0 0 0\n").find("fewer than two points"), std::string::npos);
  EXPECT_NE(mistake("0 0 0 0\n", {.columns = "t x y"}).find("--columns"), std::string::npos);
  EXPECT_NE(mistake("0 0 0 0\n", {.columns = "t x y z fx"}).find("--columns"), std::string::npos);
}

/// Creates the motion of a device on a ball of 400 N/m whose surface gives the forces: the pipeline
/// for measured data, with exact values instead of measurements.
TEST(Trajectory, AnalyticProbeReproducesItsForces) {
  const auto scene =
      scene::load_scene(std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes/rubber.yaml");
  ASSERT_TRUE(scene) << scene.error().message;
  scene::Scene plain = *scene;
  plain.objects[0].effects.clear();
  plain.objects[0].damping = 0;
  const double k = plain.objects[0].stiffness;
  const Eigen::Vector3d centre = plain.objects[0].p_WO;
  std::vector<session::TrajectoryPoint> way;
  for (int i = 0; i <= 2000; ++i) {
    const double t = i * 1e-3;
    const Eigen::Vector3d n =
        Eigen::Vector3d(0.6 * std::sin(3 * t), 0.6 * std::cos(2 * t), 1).normalized();
    const double force = std::max(0.0, 1.5 * std::sin(2 * t));
    way.push_back({.time = t, .p = centre + (0.04 - force / k) * n, .f = force * n});
  }
  auto objects = scene::SceneObjects::build(plain);
  ASSERT_TRUE(objects);
  const session::TrajectoryComparison compared = session::replay_trajectory(way, 1000, **objects);
  EXPECT_EQ(compared.ticks, 2001u);
  EXPECT_GT(compared.recorded_rms, 0.5);
  EXPECT_LT(compared.error_rms, 1e-6);
  EXPECT_LT(compared.direction_p99, 1e-6);
  EXPECT_GT(compared.directions, 1000u);
  EXPECT_EQ(compared.contact_disagrees, 0u);
  // Other forces are detected.
  for (session::TrajectoryPoint& point : way) point.f = 2 * Eigen::Vector3d(point.f.z(), 0, 0);
  auto again = scene::SceneObjects::build(plain);
  const session::TrajectoryComparison wrong = session::replay_trajectory(way, 1000, **again);
  EXPECT_GT(wrong.error_rms, 0.5);
  EXPECT_GT(wrong.direction_p99, 0.5);
}

/// A trajectory in the frame of a mesh file or in the world gives the same contact.
TEST(Trajectory, AcceptsTheFrameOfAMeshOrOfTheWorld) {
  const std::filesystem::path scene_file =
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes/clay.yaml";
  const auto scene = scene::load_scene(scene_file);
  ASSERT_TRUE(scene) << scene.error().message;
  const scene::SceneObject& object = scene->objects.front();
  const auto mesh = render::load_mesh(object.mesh_file);
  ASSERT_TRUE(mesh) << mesh.error().message;
  const scene::MeshPlacement place = scene::placement_of(*mesh, object);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& vertex : mesh->vertices) box.extend(vertex);
  const Eigen::Vector3d centre = box.center(), side(0.6 * box.sizes().x(), 0, 0);
  const auto lines = [&](auto&& placed) {
    std::string text;
    for (int i = 0; i <= 500; ++i) {
      const Eigen::Vector3d p = placed(centre + (1 - i / 2000.0) * side);
      char line[120];
      std::snprintf(line, sizeof line, "%.3f %.17g %.17g %.17g\n", 1e-3 * i, p.x(), p.y(), p.z());
      text += line;
    }
    return text;
  };
  const auto own = session::replay_trajectory_file(
      file_of(lines([](const Eigen::Vector3d& p) { return p; })), {}, object.name, scene_file);
  ASSERT_TRUE(own) << own.error().message;
  EXPECT_GT(own->compared.touching, 20u);
  EXPECT_EQ(own->felt.ticks.size(), own->compared.ticks);
  EXPECT_EQ(own->felt.info.scene, "clay");
  const auto world = session::replay_trajectory_file(
      file_of(lines([&](const Eigen::Vector3d& p) {
        return Eigen::Vector3d(place.p_WM + place.scale * (object.R_WO * p));
      })),
      {}, "world", scene_file);
  ASSERT_TRUE(world) << world.error().message;
  EXPECT_NEAR(world->compared.force_rms, own->compared.force_rms, 1e-6 * own->compared.force_rms);
  const auto nowhere =
      session::replay_trajectory_file(file_of(lines([](const Eigen::Vector3d& p) { return p; })),
                                      {.farthest = 1e9}, "nothing", scene_file);
  ASSERT_FALSE(nowhere);
  EXPECT_NE(nowhere.error().message.find("--frame"), std::string::npos);
}

// The recorded forces rotate with the frame: a rotated object gives the same comparison.
TEST(Trajectory, ForcesAreInTheFrameOfTheMesh) {
  const std::filesystem::path folder = support::scratch_folder() / "rotated";
  std::filesystem::create_directories(folder);
  const auto compared = [&folder](const std::string& rotation) {
    const auto file = folder / "cube.yaml";
    std::ofstream(file) << "name: cube\narm: vintage_phantom\nduration: 1\nobjects:\n"
                           "  - {name: cube, mesh: \"" THIMBLE_SOURCE_DIR
                           "/tests/data/meshes/box.off\", size: 0.04, stiffness: 500, "
                           "rotate_degrees: " +
                               rotation +
                               "}\nhand: {path: [{t: 0, at: [0, 0, 0.05]}, "
                               "{t: 1, at: [0, 0, 0.05]}]}\n";
    const auto scene = scene::load_scene(file);
    EXPECT_TRUE(scene) << scene.error().message;
    const auto mesh = render::load_mesh(scene->objects.front().mesh_file);
    Eigen::AlignedBox3d box;
    for (const Eigen::Vector3d& vertex : mesh->vertices) box.extend(vertex);
    std::string text;
    for (int i = 0; i <= 100; ++i) {
      const Eigen::Vector3d p =
          box.center() + box.sizes().z() * Eigen::Vector3d(0.01, 0.007, 1 - 0.0055 * i);
      char line[200];
      std::snprintf(line, sizeof line, "%.3f %.17g %.17g %.17g 0 0 1\n", 1e-3 * i, p.x(), p.y(),
                    p.z());
      text += line;
    }
    const auto replay = session::replay_trajectory_file(
        file_of(text), {.columns = "t x y z fx fy fz"}, "cube", file);
    EXPECT_TRUE(replay) << replay.error().message;
    return replay->compared;
  };
  const auto upright = compared("[]"), lying = compared("[[x, 90]]");
  EXPECT_GT(upright.touching, 5U);
  EXPECT_GT(upright.directions, 5U);
  EXPECT_EQ(lying.directions, upright.directions);
  EXPECT_NEAR(lying.error_rms, upright.error_rms, 1e-9);
  EXPECT_NEAR(upright.direction_p99, 0, 1e-6);
  EXPECT_NEAR(lying.direction_p99, 0, 1e-6);
}

}  // namespace
}  // namespace thimble::scene
