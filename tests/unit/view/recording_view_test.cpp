#include "view/playback/recording_view.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "support/scratch.h"
#include "view/shot.h"

namespace thimble::view {
namespace {

namespace fs = std::filesystem;

// Moments that a viewer of the run displayed, and the recording of the same run.
struct Seen {
  std::vector<DrawnMoment> moments;
  std::unique_ptr<RecordingView> recorded;
};

Seen see(const std::string& scene, const std::vector<double>& times) {
  const fs::path folder = support::scratch_folder() / scene;
  fs::create_directories(folder);
  session::SessionOptions options;
  options.several_arms = true;
  options.duration = times.back() + 0.05;
  options.record = folder / "run.h5";
  options.overwrite = true;
  std::vector<std::string> arms = {""};
  Seen seen;
  {
    auto played =
        PlayedScene::open(fs::path(THIMBLE_SOURCE_DIR) / "app/scenes" / (scene + ".yaml"), options);
    if (!played) {
      ADD_FAILURE() << played.error().message;
      return seen;
    }
    (*played)->play(times,
                    [&](DrawnMoment& moment, const Plots&) { seen.moments.push_back(moment); });
    if (!seen.moments.back().others.empty()) {
      arms = {(*played)->drawn().arm_in_scene, seen.moments.back().others[0].name};
    }
  }
  std::vector<fs::path> files;
  for (const std::string& arm : arms) files.push_back(session::file_of_arm(options.record, arm));
  auto recorded = RecordingView::open(files);
  EXPECT_TRUE(recorded) << recorded.error().message;
  if (recorded) seen.recorded = std::move(recorded).value();
  return seen;
}

// Positions, m, that single precision cannot distinguish better.
constexpr double kSingle = 1e-8;

void expect_same(const DrawnMoment& then, const DrawnMoment& now, double exact) {
  EXPECT_EQ(now.tick.tick, then.tick.tick);
  EXPECT_EQ(now.tick.p_WT, then.tick.p_WT);
  EXPECT_EQ(now.tick.f_sent_W, then.tick.f_sent_W);
  ASSERT_EQ(now.poses.size(), then.poses.size());
  for (std::size_t i = 0; i < then.poses.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(now.poses[i].p_WB[k], then.poses[i].p_WB[k], exact);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(now.poses[i].q_WB[k], then.poses[i].q_WB[k], exact);
    }
  }
  ASSERT_EQ(now.patch.triangle_count, then.patch.triangle_count);
  for (std::size_t i = 0; i < then.patch.triangle_count; ++i) {
    EXPECT_EQ(now.patch.triangles[i], then.patch.triangles[i]);
    EXPECT_EQ(now.patch.source[i], then.patch.source[i]);
    for (const std::uint16_t point : then.patch.triangles[i]) {
      EXPECT_EQ(now.patch.points[point].vertex, then.patch.points[point].vertex);
      for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_NEAR(now.patch.points[point].p[k], then.patch.points[point].p[k], kSingle);
      }
    }
  }
  ASSERT_EQ(now.arm.size(), then.arm.size());
  for (std::size_t i = 0; i < then.arm.size(); ++i) {
    EXPECT_TRUE(now.arm[i].second.isApprox(then.arm[i].second, 1e-12));
  }
  ASSERT_EQ(now.others.size(), then.others.size());
  for (std::size_t i = 0; i < then.others.size(); ++i) {
    EXPECT_EQ(now.others[i].name, then.others[i].name);
    EXPECT_EQ(now.others[i].rods.size(), then.others[i].rods.size());
  }
}

// `exact`: tolerance of bodies, m and parts of quaternions.
void expect_as_seen(const std::string& scene, const std::vector<double>& times,
                    double exact = 1e-12) {
  SCOPED_TRACE(scene);
  const Seen seen = see(scene, times);
  ASSERT_EQ(seen.moments.size(), times.size());
  ASSERT_NE(seen.recorded, nullptr);
  // The moments must contain the tested features.
  const auto& first = seen.moments.front();
  const auto& last = seen.moments.back();
  EXPECT_TRUE(last.patch.triangle_count > 0 ||
              std::any_of(last.poses.begin(), last.poses.end(), [&](const auto& pose) {
                return pose.p_WB !=
                       first.poses[static_cast<std::size_t>(&pose - last.poses.data())].p_WB;
              }));
  const auto now = std::make_unique<DrawnMoment>();
  // In reverse as well, because a recording can be shown in any order.
  for (std::size_t i = times.size(); i-- > 0;) {
    const DrawnMoment& then = seen.moments[i];
    seen.recorded->show(1e-9 * static_cast<double>(then.tick.time_ns), *now);
    expect_same(then, *now, exact);
    for (std::size_t arm = 0; arm < then.others.size(); ++arm) {
      // At a tick of the first arm, the previous ticks of the other arms are shown, because theirs
      // are later.
      const driver::TickRecord& of_other = then.others[arm].tick;
      ASSERT_EQ(of_other.tick + 1, then.tick.tick);
      EXPECT_EQ(now->others[arm].tick.tick, then.tick.tick);
      EXPECT_EQ(seen.recorded->ticks(arm + 1)[of_other.tick].p_WT, of_other.p_WT);
      EXPECT_EQ(seen.recorded->ticks(arm + 1)[of_other.tick].f_sent_W, of_other.f_sent_W);
    }
  }
}

TEST(RecordingView, ShowsDentsAsTheyWere) {
  expect_as_seen("water_balloon", {0.4, 0.9, 1.4});
}

TEST(RecordingView, ShowsDentsBetweenTheirDrawings) {
  expect_as_seen("water_balloon", {0.407, 0.913, 1.399});
}

TEST(PlayedScene, LooksAtTheTickOfEachTime) {
  for (const char* scene : {"water_balloon", "sandpaper"}) {  // with dents and without
    const Seen seen = see(scene, {0.5 / 3, 0.401, 0.402, 0.4035, 0.407});
    std::vector<std::uint64_t> ticks;
    for (const DrawnMoment& moment : seen.moments) ticks.push_back(moment.tick.tick);
    EXPECT_EQ(ticks, (std::vector<std::uint64_t>{166, 401, 402, 403, 407})) << scene;
  }
}

TEST(RecordingView, ShowsBodiesWhereTheyWere) {
  expect_as_seen("floating_block", {0.4, 1.2, 2.0});
}

TEST(RecordingView, ShowsAllBodiesThatMeet) {
  const std::vector<double> times = {0.4, 1.6, 2.4};
  const Seen seen = see("dominoes", times);
  ASSERT_EQ(seen.moments.size(), 3U);
  for (std::size_t domino = 1; domino <= 8; ++domino) {  // after the table
    EXPECT_NE(seen.moments[2].poses.at(domino).p_WB, seen.moments[0].poses.at(domino).p_WB)
        << domino;
  }
  expect_as_seen("dominoes", times);
}

TEST(RecordingView, ShowsTheShapesThatCollide) {
  const Seen seen = see("cans", {0.1});
  ASSERT_NE(seen.recorded, nullptr);
  const auto& objects = seen.recorded->scene().objects;
  EXPECT_TRUE(objects[0].collider.triangles.empty()) << "a plane has no end";
  for (const std::size_t can : {1, 2}) {
    EXPECT_GT(objects[can].collider.triangles.size(), 50U) << can;
    EXPECT_LT(objects[can].collider.triangles.size(), objects[can].mesh.triangles.size());
  }
}

TEST(RecordingView, ShowsSeveralArms) {
  expect_as_seen("two_hands", {0.2, 0.7, 1.2}, 1e-4);  // its motion in a tick
}

TEST(RecordingView, ShowsPermanentShapes) {
  const Seen seen = see("clay", {0.1, 3.0});
  ASSERT_EQ(seen.moments.size(), 2U);
  ASSERT_NE(seen.recorded, nullptr);
  const auto now = std::make_unique<DrawnMoment>();
  const auto moved = [&](const DrawnMoment& moment) {
    double max = 0;  // m, of all vertices
    if (!moment.shapes.at(0)) return max;
    const auto& first = seen.recorded->scene().objects[0].mesh.vertices;
    for (std::size_t i = 0; i < first.size(); ++i) {
      max = std::max(max, (moment.shapes[0]->vertices[i] - first[i]).norm());
    }
    return max;
  };
  ASSERT_GT(moved(seen.moments[1]), 1e-3);
  seen.recorded->show(0.1, *now);
  EXPECT_LT(moved(*now), 1e-9);
  seen.recorded->show(3.0, *now);
  EXPECT_GT(moved(*now), 0.5 * moved(seen.moments[1]));
  const auto& about = seen.recorded->about();
  EXPECT_TRUE(std::any_of(about.begin(), about.end(), [](const std::string& sentence) {
    return sentence.find("Permanent shapes are shown at steps of 0.25 s") != std::string::npos;
  }));
}

// A can that rolls after its wall snapped in. Permanent shapes are drawn in the pose of the object,
// as its dent is.
TEST(RecordingView, ShowsLastingShapesOnAMovedObject) {
  const Seen seen = see("tin_can", {6.7});
  ASSERT_NE(seen.recorded, nullptr);
  const auto now = std::make_unique<DrawnMoment>();
  seen.recorded->show(6.7, *now);
  const auto& p_WB = now->poses.at(0).p_WB;
  ASSERT_GT(std::hypot(p_WB[0], p_WB[1], p_WB[2]), 1e-4);
  ASSERT_NE(now->shapes.at(0), nullptr);
  const auto& first = seen.recorded->scene().objects[0].mesh.vertices;
  std::vector<double> off(first.size());  // m
  for (std::size_t i = 0; i < first.size(); ++i) {
    off[i] = (now->shapes[0]->vertices.at(i) - first[i]).norm();
  }
  // The dent under the finger is part of it.
  std::nth_element(off.begin(), off.begin() + off.size() / 2, off.end());
  EXPECT_LT(off[off.size() / 2], kSingle);
  for (std::size_t i = 0; i < now->patch.point_count; ++i) {
    const auto& point = now->patch.points[i];
    if (point.vertex < 0) continue;
    const auto& p = now->shapes[0]->vertices.at(static_cast<std::size_t>(point.vertex));
    EXPECT_LT(std::hypot(p[0] - point.p[0], p[1] - point.p[1], p[2] - point.p[2]), 2e-3);
  }
}

TEST(RecordingView, StepsFromTickToTick) {
  const Seen seen = see("water_balloon", {0.1});
  ASSERT_NE(seen.recorded, nullptr);
  const RecordingView& recorded = *seen.recorded;
  const auto now = std::make_unique<DrawnMoment>();
  double time = recorded.time().begin;
  for (std::uint64_t i = 0; i < 50; ++i) {
    recorded.show(time, *now);
    EXPECT_EQ(now->tick.tick, i);
    time = recorded.time_of_step(time, 1);
  }
  recorded.show(recorded.time_of_step(time, -1), *now);
  EXPECT_EQ(now->tick.tick, 49U);
  EXPECT_EQ(recorded.time_of_step(time, -1000), recorded.time().begin);
  EXPECT_EQ(recorded.time_of_step(time, 100'000), recorded.time().end);
}

TEST(RecordingView, ErrorNamesWrongFile) {
  const auto opened = RecordingView::open({fs::path(THIMBLE_SOURCE_DIR) / "README.md"});
  ASSERT_FALSE(opened);
  EXPECT_NE(opened.error().message.find("README.md"), std::string::npos);
}

}  // namespace
}  // namespace thimble::view
