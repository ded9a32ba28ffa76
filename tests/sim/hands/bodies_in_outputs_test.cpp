#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "recording/replay_animation.h"
#include "setup.h"
#include "share/shared_reader.h"
#include "share/shared_run.h"
#include "support/scratch.h"
#include "support/shipped_scenes.h"
#include "thimble/render/scene_touch.h"
#include "thimble/scene/scene_file.h"
#include "thimble/session/recording.h"
#include "thimble/session/session.h"

// Outputs of a run whose bodies meet: each contains all bodies, not the first one only.

namespace thimble {
namespace {

const std::atomic<bool> kGoOn{false};

using Poses = std::map<std::string, std::array<double, 7>>;

/// Returns the poses of all objects that move.
Poses poses_of(const scene::Scene& scene, const scene::SceneObjects& objects) {
  Poses poses;
  for (const std::size_t i : objects.moving()) {
    const render::BodyPose pose = objects.touch().object(i).pose();
    auto& to = poses[scene.objects[i].name];
    std::copy(pose.p_WB.begin(), pose.p_WB.end(), to.begin());
    std::copy(pose.q_WB.begin(), pose.q_WB.end(), to.begin() + 3);
  }
  return poses;
}

/// A recorded run: its recordings, and where its bodies were at its end.
struct Recorded {
  std::vector<session::Recording> recordings;
  Poses poses;
};

Recorded recorded_run(const std::filesystem::path& scene, double duration,
                      const std::vector<std::string>& arms) {
  session::SessionOptions options;
  options.several_arms = true;
  options.duration = duration;
  options.record = support::scratch_folder() / "bodies.h5";
  options.overwrite = true;
  auto opened = session::Session::open(scene, options);
  if (!opened) {
    ADD_FAILURE() << opened.error().message;
    return {};
  }
  session::Session& session = **opened;
  EXPECT_EQ(session.run(kGoOn), driver::ServoEnd::kDone);
  EXPECT_TRUE(session.end_recording());
  Recorded run;
  run.poses = poses_of(session.scene(), session.setup().objects());
  for (const std::string& arm : arms) {
    auto read = session::read_recording(session::file_of_arm(options.record, arm));
    EXPECT_TRUE(read) << (read ? "" : read.error().message);
    if (read) run.recordings.push_back(std::move(read).value());
  }
  return run;
}

/// Replays a run and compares forces and bodies with it.
void expect_replayed(const Recorded& run) {
  ASSERT_FALSE(run.recordings.empty());
  session::ReplayAnimation film;
  const auto replays = session::replay_together(run.recordings, {}, &film);
  ASSERT_TRUE(replays) << replays.error().message;
  for (const session::Replay& replay : *replays) {
    EXPECT_EQ(replay.compared.differing, 0u);
    EXPECT_GT(replay.compared.ticks, 1000u);
  }
  const Poses poses = poses_of(film.scene(), film.objects());
  EXPECT_EQ(poses.size(), run.poses.size());
  for (const auto& [name, pose] : run.poses) {
    EXPECT_GT(std::abs(pose[0]) + std::abs(pose[1]), 1e-4) << name << " did not move";
    EXPECT_EQ(poses.at(name), pose) << name;
  }
  // The animation has the same bodies, in the order of the scene.
  const session::BodyTrace* bodies = film.bodies();
  ASSERT_TRUE(bodies);
  const std::size_t count = bodies->moving().size();
  ASSERT_EQ(count, run.poses.size());
  ASSERT_GE(bodies->poses().size(), 2 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const render::BodyPose& last = bodies->poses()[bodies->poses().size() - count + i];
    const std::string& name = film.scene().objects[bodies->moving()[i]].name;
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(last.p_WB[k], run.poses.at(name)[k], 0.01) << name;  // it is up to 1/60 s older
    }
  }
}

TEST(BodiesInOutputs, AReplayMovesAllBodies) {
  const Recorded run = recorded_run(support::scene_file("dominoes"), 4, {""});
  EXPECT_EQ(run.poses.size(), 8u);
  expect_replayed(run);
}

TEST(BodiesInOutputs, AReplayRepeatsDentsAndMotion) {
  const Recorded run = recorded_run(support::scene_file("cans"), 8, {""});
  EXPECT_EQ(run.poses.size(), 2u);
  expect_replayed(run);
}

// Two hands push two blocks against each other.
TEST(BodiesInOutputs, AReplayOfTwoArmsMovesAllBodies) {
  const std::filesystem::path file = support::scratch_folder() / "two_blocks.yaml";
  const auto arm = [](const char* name, int side) {
    const std::string s = side < 0 ? "-" : "";
    return std::string("  - name: ") + name +
           "\n    arm: vintage_phantom\n    at: {position: [0, " + s + "0.06, 0]" +
           (side > 0 ? ", turn_degrees: 180" : "") +
           "}\n    hand:\n      path:\n        - {t: 0, at: [0, " + s + "0.06, -0.03]}\n" +
           "        - {t: 1.5, at: [0, " + s + "0.02, -0.03]}\n        - {t: 2, at: [0.002, " + s +
           "0.05, -0.03]}\n";
  };
  const auto block = [](const char* name, const char* y) {
    return std::string("  - name: ") + name + "\n    box: {sides: [0.03, 0.03, 0.03]}\n" +
           "    position: [0.003, " + y + ", -0.0349]\n    stiffness: 600\n    damping: 2\n" +
           "    body: {motion: {kind: rigid, mass: 0.05, gravity: [0, 0, -9.81]}}\n";
  };
  std::ofstream(file)
      << "name: two_blocks\nduration: 2\nseed: 1\narms:\n"
      << arm("left", -1) << arm("right", 1)
      << "objects:\n  - {name: table, plane: {}, position: [0, 0, -0.05], stiffness: "
         "700}\n"
      << block("near", "-0.03") << block("far", "0.03");
  const Recorded run = recorded_run(file, 2, {"left", "right"});
  EXPECT_EQ(run.poses.size(), 2u);
  expect_replayed(run);
}

/// A run with viewers, and their side of its memory.
struct Watched {
  std::unique_ptr<session::Session> session;
  std::unique_ptr<session::SharedReader> reader;
};

Watched watched(const std::string& scene, double duration) {
  session::SessionOptions options;
  options.duration = duration;
  options.share = true;
  Watched run;
  auto opened = session::Session::open(support::scene_file(scene), options);
  EXPECT_TRUE(opened) << (opened ? "" : opened.error().message);
  run.session = std::move(opened).value();
  run.reader = session::SharedReader::over(run.session->shared()->memory().again().value()).value();
  return run;
}

TEST(BodiesInOutputs, AViewerSeesAllBodies) {
  const Watched run = watched("dominoes", 4);
  EXPECT_EQ(run.session->run(kGoOn), driver::ServoEnd::kDone);
  session::ScenePoses seen;
  ASSERT_TRUE(run.reader->poses(seen));
  const auto& objects = run.session->setup().objects();
  ASSERT_EQ(seen.count, 8u);
  for (std::size_t i = 0; i < seen.count; ++i) {
    ASSERT_EQ(static_cast<std::size_t>(seen.object[i]), objects.moving()[i]);
    EXPECT_TRUE(run.reader->scene().objects[objects.moving()[i]].moves);
    const render::BodyPose pose = objects.touch().object(objects.moving()[i]).pose();
    EXPECT_EQ(seen.pose[i].p_WB, pose.p_WB) << i;
    EXPECT_EQ(seen.pose[i].q_WB, pose.q_WB) << i;
  }
}

TEST(BodiesInOutputs, AViewerSeesTheShapesThatCollide) {
  const Watched run = watched("cans", 0.1);
  const session::SharedScene& scene = run.reader->scene();
  const auto& [table, full, empty] = std::tie(scene.objects[0], scene.objects[1], scene.objects[2]);
  EXPECT_EQ(table.collider_first_triangle, table.first_triangle) << "its own shape";
  EXPECT_EQ(table.collider_triangle_count, table.triangle_count);
  for (const auto* can : {&full, &empty}) {
    ASSERT_GT(can->collider_triangle_count, 50u) << can->name;
    EXPECT_NE(can->collider_first_triangle, can->first_triangle);
    for (std::size_t v = 0; v < can->collider_vertex_count; ++v) {
      const Eigen::Vector3d& p = scene.vertices[can->collider_first_vertex + v];
      const double y = can == &full ? -0.04 : 0.06;
      EXPECT_LT(std::hypot(p.x(), p.y() - y), 0.0331) << "the can has a radius of 33 mm";
    }
  }
  EXPECT_NE(full.collider_first_triangle, empty.collider_first_triangle);
}

TEST(BodiesInOutputs, ASceneWithOneBodyHasNoShapesThatCollide) {
  const Watched run = watched("tin_can", 0.1);
  EXPECT_EQ(run.reader->scene().objects[0].collider_triangle_count, 0u);
}

}  // namespace
}  // namespace thimble
