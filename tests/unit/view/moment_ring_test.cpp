#include "view/playback/moment_ring.h"

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

namespace thimble::view {
namespace {

// A moment in which each part encodes its time.
void make(double time, DrawnMoment& moment) {
  moment.tick = {};
  moment.tick.time_ns = std::llround(1e9 * time);
  moment.tick.p_WT = {time, 0, 0};
  moment.poses.resize(1);
  moment.poses[0].p_WB = {0, time, 0};
  moment.arm = {{Eigen::Vector3d(0, 0, time), Eigen::Vector3d::Zero()}};
  moment.patch.object = 0;
  moment.patch.point_count = 3;
  moment.patch.triangle_count = 1;
  moment.patch.points[0].p = {0, 0, time};
  moment.patch.points[0].vertex = 7;
  moment.patch.triangles[0] = {0, 1, 2};
  moment.patch.source[0] = 5;
}

TEST(MomentRing, ShowsTheNewestMomentThatIsNoLater) {
  const auto moment = std::make_unique<DrawnMoment>();
  MomentRing ring;
  EXPECT_FALSE(ring.show(0, *moment));
  for (int i = 0; i < 100; ++i) {
    make(0.05 * i, *moment);
    ring.keep(*moment);
  }
  const auto shown = std::make_unique<DrawnMoment>();
  for (const double time : {0.0, 0.051, 2.5001, 3.3499, 4.96}) {
    ASSERT_TRUE(ring.show(time, *shown));
    const double expected = 0.05 * std::floor(time / 0.05);
    EXPECT_NEAR(shown->tick.p_WT[0], expected, 1e-9);
    EXPECT_NEAR(shown->poses[0].p_WB[1], expected, 1e-9);
    EXPECT_NEAR(shown->arm[0].first.z(), expected, 1e-9);
    ASSERT_EQ(shown->patch.triangle_count, 1);
    EXPECT_NEAR(shown->patch.points[0].p[2], expected, 1e-9);
    EXPECT_EQ(shown->patch.points[0].vertex, 7);
    EXPECT_EQ(shown->patch.source[0], 5);
  }
  EXPECT_NEAR(ring.time_of_step(2.51, 0), 2.5, 1e-9);
  EXPECT_NEAR(ring.time_of_step(2.51, 2), 2.6, 1e-9);
  EXPECT_NEAR(ring.time_of_step(2.51, -3), 2.35, 1e-9);
  EXPECT_EQ(ring.time_of_step(2.51, -1000), ring.oldest());
  EXPECT_EQ(ring.time_of_step(2.51, 1000), ring.newest());
  ring.show(-10, *shown);
  EXPECT_EQ(shown->tick.p_WT[0], 0);
}

TEST(MomentRing, ForgetsAFinishedDent) {
  const auto moment = std::make_unique<DrawnMoment>();
  MomentRing ring;
  make(0, *moment);
  ring.keep(*moment);
  moment->tick.time_ns = 100'000'000;
  moment->patch.triangle_count = 0;
  ring.keep(*moment);
  const auto shown = std::make_unique<DrawnMoment>();
  ring.show(0, *shown);
  EXPECT_EQ(shown->patch.triangle_count, 1);
  ring.show(0.1, *shown);
  EXPECT_EQ(shown->patch.triangle_count, 0);
}

TEST(MomentRing, KeepsAMinuteAndIsClearedByAnotherRun) {
  const auto moment = std::make_unique<DrawnMoment>();
  MomentRing ring;
  for (int i = 0; i < 150 * 60; ++i) {
    make(i / 60.0, *moment);
    ring.keep(*moment);
  }
  EXPECT_NEAR(ring.newest() - ring.oldest(), MomentRing::kSeconds, 2 * MomentRing::kStep);
  EXPECT_LE(ring.moments(), 1802U);
  EXPECT_LT(ring.bytes(), 4'000'000U);
  make(0.5, *moment);
  ring.keep(*moment);
  EXPECT_EQ(ring.moments(), 1U);
  EXPECT_EQ(ring.oldest(), 0.5);
}

TEST(MomentRing, KeepsFewerSecondsOfLargeMoments) {
  const auto moment = std::make_unique<DrawnMoment>();
  MomentRing ring;
  std::vector<std::weak_ptr<const render::TriangleMesh>> meshes;
  for (int i = 0; i < 60 * 30; ++i) {
    make(i / 30.0 + 1e-6, *moment);
    const auto mesh = std::make_shared<render::TriangleMesh>();
    mesh->vertices.resize(40'000);
    moment->shapes = {mesh};
    meshes.push_back(moment->shapes[0]);
    ring.keep(*moment);
  }
  moment->shapes.clear();
  // Memory, by the reference counts and not by the ring's own count.
  std::size_t alive = 0;
  for (const auto& mesh : meshes) alive += mesh.expired() ? 0 : 1;
  const std::size_t bytes = alive * 40'000 * sizeof(Eigen::Vector3d);
  EXPECT_LE(bytes, MomentRing::kBytesMax);
  EXPECT_LE(ring.bytes(), MomentRing::kBytesMax);
  EXPECT_GE(ring.bytes(), bytes);
  EXPECT_GT(bytes, MomentRing::kBytesMax / 2);
  EXPECT_LT(ring.newest() - ring.oldest(), MomentRing::kSeconds);
  ring.clear();
  EXPECT_EQ(ring.bytes(), 0U);
}

}  // namespace
}  // namespace thimble::view
