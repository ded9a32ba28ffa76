// A tip that is a ball, among several solids that are felt as one.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "support/box_union.h"
#include "support/heap_guard.h"
#include "support/tip_at.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/scene_touch.h"
#include "world/contact_world.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::SolidBlock;
using support::tip_at;

constexpr double kStiffness = 800, kRadius = 0.003;

/// Boxes as meshes, or as shapes without one.
SceneTouch scene_of(const std::vector<SolidBlock>& blocks, bool meshes) {
  if (meshes) return support::scene_of(blocks, {.tip_radius = kRadius});
  std::vector<std::unique_ptr<ObjectTouch>> objects;
  for (const SolidBlock& block : blocks) {
    EntryFaceBox box;
    box.R_WO = block.R;
    box.p_WO = block.centre;
    box.half_sides = block.half;
    objects.push_back(
        build_primitive_touch(box, {.spring = {.stiffness = block.stiffness}}, kRadius));
  }
  return SceneTouch(std::move(objects));
}

class BallWorld : public testing::TestWithParam<bool> {};

TEST_P(BallWorld, ASeamOfFlushBoxesIsNotFelt) {
  SceneTouch scene = scene_of({{.centre = {-0.015, 0, -0.01}, .half = {0.015, 0.03, 0.01}},
                               {.centre = {0.015, 0, -0.01}, .half = {0.015, 0.03, 0.01}}},
                              GetParam());
  for (const int direction : {1, -1}) {
    scene(tip_at({-0.008 * direction, 0.001, 0.02}));
    for (int i = 0; i <= 4000; ++i) {
      const double x = direction * (-0.008 + 4e-6 * i);
      const double z = kRadius + std::max(-0.0008, 0.0008 - 16e-6 * i);
      const driver::ForceCommand one = scene(tip_at({x, 0.001, z}));
      const Vector3d f(0, 0, kStiffness * std::max(0.0, kRadius - z));
      ASSERT_LT((one.f_T_W - f).norm(), 1e-6) << i;
    }
  }
  EXPECT_EQ(scene.world()->counters().unsettled, 0u);
}

TEST_P(BallWorld, ABlockOnATableStopsTheBallByItsRadius) {
  // The side of the block is at x = 0.
  SceneTouch scene = scene_of({{.centre = {0, 0, -0.01}, .half = {0.03, 0.03, 0.01}},
                               {.centre = {0.015, 0, 0.0075}, .half = {0.015, 0.03, 0.0075}}},
                              GetParam());
  scene(tip_at({-0.01, 0.001, 0.02}));
  driver::ForceCommand last;
  EXPECT_EQ(support::heap_calls_of([&] {
              for (int i = 0; i <= 2000; ++i) {
                const double z = kRadius + std::max(-0.002, 0.002 - 1e-5 * i);
                const double x = -0.01 + std::max(0, i - 600) * 8e-6;  // up to 1.2 mm
                last = scene(tip_at({x, 0.001, z}));
                const Vector3d f(-kStiffness * std::max(0.0, x + kRadius), 0,
                                 kStiffness * std::max(0.0, kRadius - z));
                ASSERT_LT((last.f_T_W - f).norm(), 1e-6) << i;
              }
            }),
            0);
  EXPECT_GT(-last.f_T_W.x(), 3);
  EXPECT_GT(last.f_T_W.z(), 1);
}

TEST_P(BallWorld, ABallOverTheRimRollsOffOneBoxOntoTheNextOne) {
  // The second box is 2 mm lower.
  SceneTouch scene = scene_of({{.centre = {-0.015, 0, -0.01}, .half = {0.015, 0.03, 0.01}},
                               {.centre = {0.015, 0, -0.012}, .half = {0.015, 0.03, 0.01}}},
                              GetParam());
  scene(tip_at({-0.008, 0.001, 0.02}));
  const double depth = 0.0005;
  int rim = 0;
  for (int i = 0; i <= 4000; ++i) {
    const double x = -0.008 + 4e-6 * i;
    // The height of the ball's centre over the first box, around the rim, and over the second one.
    const double over = std::max(0.0, x);
    double height = -0.002 + kRadius;
    if (over < kRadius) height = std::max(height, std::sqrt(kRadius * kRadius - over * over));
    const Vector3d p(x, 0.001, height - std::min(depth, 1e-6 * i));
    scene(tip_at(p));
    const Vector3d q = scene.world()->proxy();
    const double first = std::hypot(std::max(0.0, q.x()), q.z()), second = q.z() + 0.002;
    const double least = q.x() < 0 ? q.z() : std::min(first, second);
    ASSERT_NEAR(least, kRadius, 1e-9) << i;
    if (q.x() > 0 && first < kRadius + 1e-9) ++rim;
  }
  EXPECT_GT(rim, 300);
}

INSTANTIATE_TEST_SUITE_P(Boxes, BallWorld, testing::Bool(),
                         [](const auto& each) { return each.param ? "Meshes" : "Shapes"; });

}  // namespace
}  // namespace thimble::render
