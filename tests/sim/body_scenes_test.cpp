#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "lost_contacts.h"
#include "session.h"
#include "support/heap_guard.h"
#include "support/run_hash.h"
#include "support/scratch.h"
#include "thimble/render/body/body_shape.h"
#include "thimble/render/contact/contact_mesh.h"
#include "thimble/render/effect/effect_table.h"
#include "thimble/render/mesh/load_mesh.h"
#include "thimble/render/mesh/save_mesh.h"

// The scenes with bodies that move, keep what they gave way, and snap, from the wire up.

namespace thimble {
namespace {

using Eigen::Vector3d;

std::unique_ptr<app::Session> open(const std::string& name) {
  auto opened = app::Session::open(
      std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes" / (name + ".yaml"), {});
  EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
  return opened ? std::move(opened).value() : nullptr;
}

std::uint64_t hash_of(const app::Session& session) {
  support::RunHash hash;
  for (const auto& row : session.trace().rows()) {
    hash.add(row.p_WT);
    hash.add(row.f_wanted_W);
    hash.add(row.depth);
    hash.add(row.feature);
  }
  for (const Vector3d& p : session.mesh_now().vertices) {
    for (const double x : p) hash.add(x);
  }
  return hash.value();
}

struct BodyScene {
  const char* name;
  // One hash for every build type; see determinism_test.cpp. A change of the scene, the arm's data
  // or any force shows here: store the new one only if it was meant.
  std::uint64_t stored;
};

void PrintTo(const BodyScene& scene, std::ostream* out) {
  *out << scene.name;
}

class SceneWithBodies : public ::testing::TestWithParam<BodyScene> {};

TEST_P(SceneWithBodies, RunsForItsWholeTimeAlikeEachTimeWithoutAFaultALostContactOrTheHeap) {
  if (!std::any_of(render::effect_table().begin(), render::effect_table().end(),
                   [](const auto& kind) { return kind.name == "bristle"; })) {
    GTEST_SKIP() << "this build knows no friction";
  }
  std::uint64_t first = 0;
  for (int time = 0; time < 2; ++time) {
    const auto session = open(GetParam().name);
    ASSERT_TRUE(session);
    EXPECT_GT(session->scene().description.size(), 40u) << "says what to feel";
    driver::ServoEnd end{};
    EXPECT_EQ(support::heap_calls_of([&] { end = session->run(std::atomic<bool>{false}); }), 0);
    EXPECT_EQ(end, driver::ServoEnd::kDone);
    EXPECT_EQ(session->device().fault(), driver::Fault::kNone);
    EXPECT_EQ(app::count_lost_contacts(session->trace().rows(), session->touch()), 0u);
    EXPECT_GT(session->statistics().force_max(), 0.3);
    EXPECT_LT(session->statistics().force_max(), session->scene().arm.limits.force_max);
    EXPECT_LT(session->statistics().energy_to_hand(), 1e-3);
    const std::uint64_t hash = hash_of(*session);
    if (time == 0) first = hash;
    EXPECT_EQ(hash, first);
    EXPECT_EQ(hash, GetParam().stored) << "new hash: 0x" << std::hex << hash;
  }
}

INSTANTIATE_TEST_SUITE_P(ByName, SceneWithBodies,
                         ::testing::Values(BodyScene{"clay", 0x26630134154c4be7},
                                           BodyScene{"floating_block", 0xc953b9ac9560fe8a},
                                           BodyScene{"held_block", 0xaa58f955f149e32e},
                                           BodyScene{"soft_coarse", 0x40eee37a59d498b8},
                                           BodyScene{"tin_can", 0xd1dfaed21159d1ee},
                                           BodyScene{"trampoline", 0xf65baa89f626b85d},
                                           BodyScene{"water_balloon", 0x33ec8830e6465cb0}),
                         [](const auto& scene) { return std::string(scene.param.name); });

double farthest(const app::Session& session) {
  double far = 0;
  const auto now = session.mesh_now();
  for (std::size_t v = 0; v < now.vertices.size(); ++v) {
    far = std::max(far, (now.vertices[v] - session.mesh_W().vertices[v]).norm());
  }
  return far;
}

TEST(ClayScene, KeepsItsPrints) {
  const auto session = open("clay");
  ASSERT_TRUE(session);
  ASSERT_EQ(session->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  EXPECT_GT(farthest(*session), 3e-3);
  EXPECT_LE(farthest(*session), 8e-3 * (1 + 1e-9));
  EXPECT_GT(session->touch().object(0).shape()->clay()->dissipated(), 1e-3);
  // What has been sculpted can be saved, and touched again.
  const auto file = support::scratch_folder() / "sculpted.off";
  ASSERT_TRUE(render::save_mesh(session->mesh_now(0), file));
  const auto again = render::load_mesh(file);
  ASSERT_TRUE(again);
  EXPECT_EQ(again->vertices, session->mesh_now().vertices);
  EXPECT_TRUE(render::ContactMesh::build(*again));
}

// Reads a scene with `body` on an object that is `what`; gives the error's text, empty if there is
// none.
std::string refusal(const std::string& what, const std::string& body) {
  const std::filesystem::path scenes = std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes";
  const auto file = support::scratch_folder() / "scene.yaml";
  std::ofstream(file) << "name: x\narm: " << std::filesystem::absolute(scenes).string()
                      << "/../arms/vintage_phantom.yaml\nduration: 1\nobjects:\n"
                      << "  - {name: o, " << what << ", stiffness: 500, body: " << body << "}\n"
                      << "hand: {path: [{t: 0, at: [0, 0, 0.05]}, {t: 1, at: [0, 0, 0.06]}]}\n";
  const auto session = app::Session::open(file, {});
  return session ? "" : session.error().message;
}

TEST(BodyKeys, TellWhatIsWrongWithABody) {
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
  EXPECT_TRUE(says(refusal(ball, "{motion: {mass: 1, turning: [0, 0, 1]}}"), "kind: rigid"));
  EXPECT_TRUE(says(refusal(ball, "{motion: {mass: 1, floor_friction: 1}}"), "floor"));
  EXPECT_TRUE(says(refusal(ball, "{motion: {mass: 1, time_scale: 0}}"), "time_scale"));
  EXPECT_TRUE(says(refusal(ball, "{plastic: {yield_force: -1}}"), "yield_force"));
  EXPECT_TRUE(says(refusal(ball, "{snap: {depth: 0.02, radius: 0.01}}"), "would fold"));
  EXPECT_TRUE(says(refusal(ball, "{snap: {radius: 0.002, depth: 0.001}}"), "finer mesh"));
  EXPECT_TRUE(says(refusal(ball, "{sticky: {}}"), "sticky"));
  EXPECT_TRUE(says(refusal(block, "{plastic: {}}"), "only a mesh gives way"));
  EXPECT_TRUE(says(refusal("plane: {normal: [0, 0, 1]}", "{motion: {mass: 1}}"), "no volume"));
  EXPECT_TRUE(
      says(refusal(ball + ", contact: {tracker: compact}", "{plastic: {}}"), "edge_planes"));
}

TEST(TinCanScene, SnapsTwiceAndRollsMeanwhile) {
  const auto session = open("tin_can");
  ASSERT_TRUE(session);
  ASSERT_EQ(session->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  EXPECT_EQ(session->touch().object(0).shape()->snap()->snaps(), 2);
  app::ScenePoses poses;
  ASSERT_TRUE(session->poses().load(poses));
  ASSERT_EQ(poses.count, 1u);
  EXPECT_EQ(poses.object[0], 0);
  const auto& q = poses.pose[0].q_WB;
  EXPECT_GT(2 * std::acos(std::min(std::abs(q[0]), 1.0)), 0.05) << "rad";
}

TEST(FloatingBlockScene, DriftsAndTurns) {
  const auto session = open("floating_block");
  ASSERT_TRUE(session);
  ASSERT_EQ(session->run(std::atomic<bool>{false}), driver::ServoEnd::kDone);
  app::ScenePoses poses;
  ASSERT_TRUE(session->poses().load(poses));
  ASSERT_EQ(poses.count, 1u);
  const auto& [p, q] = poses.pose[0];
  const double away = Vector3d(p[0], p[1], p[2]).norm();
  EXPECT_GT(away, 3e-3);
  EXPECT_LT(away, 0.1);
  EXPECT_GT(2 * std::acos(std::min(std::abs(q[0]), 1.0)), 0.05) << "rad";
}

}  // namespace
}  // namespace thimble
