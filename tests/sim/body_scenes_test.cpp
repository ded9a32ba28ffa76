#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "body/shape/body_shape.h"
#include "mesh/contact_mesh.h"
#include "run_records.h"
#include "setup.h"
#include "support/scratch.h"
#include "support/shipped_scene.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/scene_touch.h"
#include "thimble/session/recording.h"
#include "thimble/session/session.h"

// The scenes with bodies that move, keep dents and snap, through the complete chain from the wire
// up.

namespace thimble {
namespace {

using Eigen::Vector3d;

double farthest(const session::Session& session) {
  double far = 0;
  const auto now = session.mesh_now();
  for (std::size_t v = 0; v < now.vertices.size(); ++v) {
    far = std::max(far, (now.vertices[v] - session.setup().objects().mesh_W().vertices[v]).norm());
  }
  return far;
}

TEST(ClayScene, KeepsItsPrints) {
  const auto session = support::open_shipped("clay");
  ASSERT_TRUE(session);
  ASSERT_EQ(session->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  EXPECT_GT(farthest(*session), 3e-3);
  EXPECT_LE(farthest(*session), 8e-3 * (1 + 1e-9));
  EXPECT_GT(session->touch().object(0).shape()->clay()->dissipated(), 1e-3);
  // A sculpted shape can be saved and touched again.
  const auto file = support::scratch_folder() / "sculpted.off";
  ASSERT_TRUE(render::save_mesh(session->mesh_now(0), file));
  const auto again = render::load_mesh(file);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->vertices, session->mesh_now().vertices);
  EXPECT_TRUE(render::ContactMesh::build(*again));
}

// Triangles split under prints. The saved mesh contains the new triangles, and a repeated run and a
// replay are bit-identical.
TEST(ClayTablet, SplitTrianglesAreSavedAndReplayed) {
  session::SessionOptions options;
  options.record = support::scratch_folder() / "tablet.h5";
  const auto scene = std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes/clay_tablet.yaml";
  const auto session = session::Session::open(scene, options);
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_EQ((*session)->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  ASSERT_TRUE((*session)->end_recording());
  const auto now = (*session)->mesh_now();
  EXPECT_GT(now.triangles.size(), (*session)->setup().objects().mesh_W().triangles.size() + 5000);
  EXPECT_LT(now.triangles.size(), 20000U) << "the stroke ends before the triangles do";
  EXPECT_TRUE(render::ContactMesh::build(now));
  const auto saved = support::scratch_folder() / "tablet.off";
  ASSERT_TRUE(render::save_mesh(now, saved));
  const auto loaded = render::load_mesh(saved);
  ASSERT_TRUE(loaded);
  EXPECT_EQ(loaded->triangles, now.triangles);
  EXPECT_EQ(loaded->vertices, now.vertices);

  const auto recording = session::read_recording(options.record);
  ASSERT_TRUE(recording) << recording.error().message;
  EXPECT_TRUE(session::check_repeatable(*recording));
  const auto replay = session::replay(*recording);
  ASSERT_TRUE(replay) << replay.error().message;
  EXPECT_EQ(replay->compared.ticks, recording->ticks.size());
  EXPECT_EQ(replay->compared.differing, 0u);
}

// Reads a scene with `body` on an object `what`. Returns the error text; empty if there is none.
std::string refusal(const std::string& what, const std::string& body) {
  const std::filesystem::path scenes = std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes";
  const auto file = support::scratch_folder() / "scene.yaml";
  std::ofstream(file) << "name: x\narm: " << std::filesystem::absolute(scenes).string()
                      << "/../arms/vintage_phantom.yaml\nduration: 1\nobjects:\n"
                      << "  - {name: o, " << what << ", stiffness: 500, body: " << body << "}\n"
                      << "hand: {path: [{t: 0, at: [0, 0, 0.05]}, {t: 1, at: [0, 0, 0.06]}]}\n";
  const auto session = session::Session::open(file, {});
  return session ? "" : session.error().message;
}

TEST(BodyKeys, ErrorsNameTheWrongKey) {
  const std::string ball =
      "mesh: " + std::filesystem::relative(
                     std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes/clay_ball.off",
                     support::scratch_folder())
                     .string();
  const std::string block = "box: {sides: [0.05, 0.05, 0.05]}";
  const auto says = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos
               ? ::testing::AssertionSuccess()
               : ::testing::AssertionFailure() << '"' << text << "\" without \"" << part << '"';
  };
  EXPECT_EQ(refusal(ball, "{plastic: {}, snap: {}, motion: {mass: 0.1}}"), "");
  EXPECT_EQ(refusal(block, "{motion: {mass: 0.1, kind: rigid}}"), "");
  EXPECT_TRUE(says(refusal(ball, "{motion: {}}"), "mass"));
  EXPECT_TRUE(says(refusal(ball, "{motion: {mass: 0}}"), "mass: expected a number from 0.0001"));
  EXPECT_TRUE(says(refusal(ball, "{motion: {mass: .nan}}"), "mass"));
  EXPECT_TRUE(
      says(refusal(ball, "{motion: {mass: 1, angular_velocity: [0, 0, 1]}}"), "kind: rigid"));
  EXPECT_TRUE(says(refusal(ball, "{motion: {mass: 1, floor_friction: 1}}"), "floor"));
  EXPECT_TRUE(says(refusal(ball, "{motion: {mass: 1, time_scale: 0}}"), "time_scale"));
  EXPECT_TRUE(says(refusal(ball, "{plastic: {yield_force: -1}}"), "yield_force"));
  EXPECT_EQ(refusal(ball + ", contact: {tracker: god_object}",
                    "{plastic: {edge: 0.001, triangles: 9000, volume: kept}}"),
            "");
  EXPECT_TRUE(says(refusal(ball, "{plastic: {edge: 0.0001}}"), "edge"));
  EXPECT_TRUE(says(refusal(ball, "{plastic: {triangles: 9000}}"), "needs edge"));
  EXPECT_TRUE(says(refusal(ball, "{plastic: {edge: 0.001, triangles: 9.5}}"), "whole number"));
  const std::string felt = ball + ", contact: {tracker: god_object}";
  EXPECT_TRUE(says(refusal(felt, "{plastic: {edge: 0.001, triangles: 4}}"), "already has"));
  EXPECT_EQ(refusal(ball, "{plastic: {edge: 0.001}}"), "") << "the tracker is chosen";
  const std::string flat = ball + ", contact: {tracker: edge_planes}";
  EXPECT_TRUE(says(refusal(flat, "{plastic: {edge: 0.001}}"), "god_object"));
  EXPECT_TRUE(says(refusal(ball, "{plastic: {volume: full}}"), "kept"));
  EXPECT_TRUE(says(refusal(felt, "{plastic: {edge: 0.001}, dent: {}}"), "dent"));
  EXPECT_TRUE(says(refusal(ball, "{snap: {depth: 0.02, radius: 0.01}}"), "would fold"));
  EXPECT_TRUE(says(refusal(ball, "{snap: {radius: 0.002, depth: 0.001}}"), "finer mesh"));
  EXPECT_TRUE(says(refusal(ball, "{sticky: {}}"), "sticky"));
  EXPECT_TRUE(says(refusal(block, "{plastic: {}}"), "dent, plastic and snap need a mesh"));
  EXPECT_TRUE(says(refusal("plane: {normal: [0, 0, 1]}", "{motion: {mass: 1}}"),
                   "a plane has no end and cannot move"));
  EXPECT_TRUE(
      says(refusal(ball + ", contact: {tracker: compact}", "{plastic: {}}"), "edge_planes"));
}

TEST(TinCanScene, SnapsTwiceWhileRolling) {
  const auto session = support::open_shipped("tin_can");
  ASSERT_TRUE(session);
  ASSERT_EQ(session->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  EXPECT_EQ(session->touch().object(0).shape()->snap()->snaps(), 2);
  session::ScenePoses poses;
  ASSERT_TRUE(session->records().poses);
  poses = session->records().poses->now();
  ASSERT_EQ(poses.count, 1u);
  EXPECT_EQ(poses.object[0], 0);
  const auto& q = poses.pose[0].q_WB;
  EXPECT_GT(2 * std::acos(std::min(std::abs(q[0]), 1.0)), 0.05) << "rad";
}

// The only energy source is the weight that sinks by less than 3 mm: 0.6 mJ.
TEST(UndampedScene, EnergyIsBoundedByTheSinkingWeight) {
  const auto session = session::Session::open(
      std::filesystem::path(THIMBLE_TEST_DATA) / "scenes/undamped_drop.yaml", {});
  ASSERT_TRUE(session) << session.error().message;
  ASSERT_EQ((*session)->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  EXPECT_GT((*session)->statistics().contact_time(), 0.1);
  EXPECT_LT((*session)->statistics().energy_to_hand_max(), 6e-4);
}

TEST(FloatingBlockScene, DriftsAndTurns) {
  const auto session = support::open_shipped("floating_block");
  ASSERT_TRUE(session);
  ASSERT_EQ(session->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  session::ScenePoses poses;
  ASSERT_TRUE(session->records().poses);
  poses = session->records().poses->now();
  ASSERT_EQ(poses.count, 1u);
  const auto& [p, q] = poses.pose[0];
  const double away = Vector3d(p[0], p[1], p[2]).norm();
  EXPECT_GT(away, 3e-3);
  EXPECT_LT(away, 0.1);
  EXPECT_GT(2 * std::acos(std::min(std::abs(q[0]), 1.0)), 0.05) << "rad";
}

}  // namespace
}  // namespace thimble
