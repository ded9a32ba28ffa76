// Several objects that are felt as one: seams, corners, starts, bounds.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "support/box_union.h"
#include "support/heap_guard.h"
#include "support/long_form.h"
#include "support/random.h"
#include "support/tip_at.h"
#include "support/tracker_names.h"
#include "thimble/render/build_primitive_touch.h"
#include "thimble/render/scene_touch.h"
#include "world/contact_world.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::Random;
using support::scene_of;
using support::SolidBlock;

constexpr ContactChoice kGodObject{.tracker = TrackerChoice::kGodObject};
constexpr double kStiffness = 800;

/// The floor of seam.yaml: two flush boxes with their tops at z = 0 and the seam at x = 0.
std::vector<SolidBlock> seam() {
  return {{.centre = {-0.015, 0, -0.01}, .half = {0.015, 0.03, 0.01}},
          {.centre = {0.015, 0, -0.01}, .half = {0.015, 0.03, 0.01}}};
}

/// under_block.yaml: a block that stands on a table, with its side at x = 0.
std::vector<SolidBlock> under_block() {
  return {{.centre = {0, 0, -0.01}, .half = {0.03, 0.03, 0.01}},
          {.centre = {0.015, 0, 0.0075}, .half = {0.015, 0.03, 0.0075}}};
}

class EachTracker : public testing::TestWithParam<TrackerChoice> {
 protected:
  ContactChoice choice() const { return {.tracker = GetParam()}; }
};

TEST_P(EachTracker, ASeamOfFlushBoxesIsNotFelt) {
  SceneTouch two = scene_of(seam(), choice());
  SceneTouch one = scene_of({{.centre = {0, 0, -0.01}, .half = {0.03, 0.03, 0.01}}}, choice());
  // The corners of packed triangles are rounded, and its normals to 7e-5 rad.
  const bool exact = GetParam() != TrackerChoice::kPacked;
  const double bound = exact ? 1e-9 : 1e-6;
  for (const double y : {0.0, 0.00123}) {
    for (int direction : {1, -1}) {
      double most = 0;
      for (int i = 0; i <= 3000; ++i) {
        const double x = direction * (-0.006 + 4e-6 * i);
        const double z = i < 100 ? 0.0008 - 16e-6 * i : -0.0008;
        const driver::ForceCommand a = two(support::tip_at({x, y, z})),
                                   b = one(support::tip_at({x, y, z}));
        most = std::max(most, (a.f_T_W - b.f_T_W).norm());
        ASSERT_NEAR(a.touch.depth, b.touch.depth, bound) << x;
        ASSERT_EQ(a.touch.in_contact, b.touch.in_contact) << x;
      }
      EXPECT_LT(most, kStiffness * bound);
      two(support::tip_at({0, 0, 0.1}));
      one(support::tip_at({0, 0, 0.1}));
    }
  }
}

TEST_P(EachTracker, ABlockOnATableStopsATipThatPressesTheTable) {
  SceneTouch scene = scene_of(under_block(), choice());
  driver::ForceCommand last;
  for (int i = 0; i <= 2000; ++i) {
    const double z = std::max(-0.003, 0.002 - 1e-5 * i);
    const double x = -0.006 + std::max(0, i - 600) * 8e-6;  // up to 5.2 mm
    last = scene(support::tip_at({x, 0.001, z}));
    const double side = std::max(0.0, x);
    ASSERT_NEAR(last.f_T_W.z(), kStiffness * std::max(0.0, -z), 1e-3) << i;
    ASSERT_NEAR(-last.f_T_W.x(), kStiffness * side, 1e-3 + 1e-3 * kStiffness * side) << i;
  }
  EXPECT_NEAR(last.touch.depth, std::hypot(0.003, 0.0052), 1e-5);
}

INSTANTIATE_TEST_SUITE_P(Trackers, EachTracker, testing::ValuesIn(support::kTrackers),
                         [](const auto& each) {
                           return std::string(support::scene_name(each.param));
                         });

/// The same solids as shapes without a mesh.
template <class Shape = EntryFaceBox>
SceneTouch shapes_of(const std::vector<SolidBlock>& blocks) {
  std::vector<std::unique_ptr<ObjectTouch>> objects;
  for (const SolidBlock& block : blocks) {
    Shape box;
    box.R_WO = block.R;
    box.p_WO = block.centre;
    box.half_sides = block.half;
    objects.push_back(build_primitive_touch(box, {.spring = {.stiffness = block.stiffness}}));
  }
  return SceneTouch(std::move(objects));
}

TEST(World, ShapesWithoutAMeshAreFeltAsMeshesAre) {
  for (const std::vector<SolidBlock>& blocks : {seam(), under_block()}) {
    SceneTouch shapes = shapes_of(blocks), meshes = scene_of(blocks, kGodObject);
    ASSERT_NE(shapes.world(), nullptr);
    Random random(300);
    Vector3d p(-0.005, 0, 0.02), target = p;
    double most = 0, largest = 0;
    for (int i = 0; i < 20'000; ++i) {
      if (random.uniform(0, 1) < 0.01) {
        target = {random.uniform(-0.012, 0.012), random.uniform(-0.01, 0.01),
                  random.uniform(-0.003, 0.02)};
      }
      p += random.uniform(0, 1e-4) * (target - p).normalized();
      const driver::ForceCommand a = shapes(support::tip_at(p)), b = meshes(support::tip_at(p));
      most = std::max(most, (a.f_T_W - b.f_T_W).norm());
      largest = std::max(largest, b.f_T_W.norm());
    }
    EXPECT_LT(most, 1e-6);
    EXPECT_GT(largest, 1);
  }
}

template <class Shape>
void expect_no_seam() {
  for (const bool along_y : {false, true}) {
    std::vector<SolidBlock> blocks = seam();
    if (along_y) {
      for (SolidBlock& block : blocks) {
        std::swap(block.centre.x(), block.centre.y());
        std::swap(block.half.x(), block.half.y());
      }
    }
    for (const int order : {0, 1}) {
      if (order == 1) std::swap(blocks[0], blocks[1]);
      SceneTouch scene = shapes_of<Shape>(blocks);
      scene(support::tip_at({0, 0, 0.01}));
      // Down in the seam, along it, across it, and back.
      for (int i = -100; i <= 100; ++i) {
        const double across = i < -50 ? 0 : 1e-4 * (std::abs(i) - 50) * (i < 0 ? -1 : 1);
        const double along = 1e-5 * i, depth = std::min(8e-4, 1e-4 * (i + 100));
        const Vector3d p(along_y ? along : across, along_y ? across : along, -depth);
        const driver::ForceCommand felt = scene(support::tip_at(p));
        EXPECT_LT((felt.f_T_W - Vector3d(0, 0, kStiffness * depth)).norm(), 1e-9)
            << i << " along y " << along_y << " order " << order;
      }
    }
  }
}

TEST(World, ATickInThePlaneOfASeamOfBoxShapesIsLikeAllOthers) {
  expect_no_seam<EntryFaceBox>();
  expect_no_seam<WedgeBox>();
}

TEST(World, SphereOnAPlaneStopsATipThatPressesThePlane) {
  std::vector<std::unique_ptr<ObjectTouch>> objects;
  objects.push_back(build_primitive_touch(HalfSpace{}, {.spring = {.stiffness = kStiffness}}));
  objects.push_back(build_primitive_touch(Sphere{.p_WO = {0.02, 0, 0.015}, .radius = 0.02},
                                          {.spring = {.stiffness = kStiffness}}));
  SceneTouch scene(std::move(objects));
  driver::ForceCommand last;
  for (int i = 0; i < 2500; ++i) {
    last = scene(support::tip_at(
        {-0.01 + 1e-5 * std::max(0, i - 400), 0, std::max(-0.002, 0.002 - 1e-5 * i)}));
  }
  // The proxy rests where the sphere meets the plane.
  const double edge = 0.02 - std::sqrt(0.02 * 0.02 - 0.015 * 0.015);
  EXPECT_NEAR(scene.world()->proxy().x(), edge, 1e-8);
  EXPECT_NEAR(scene.world()->proxy().z(), 0, 1e-8);
  EXPECT_NEAR(last.f_T_W.x(), kStiffness * (edge - (-0.01 + 1e-5 * 2099)), 1e-4);
}

TEST(World, ATipThatStartsInsideFeelsTheSolidAfterLeaving) {
  SceneTouch scene = scene_of(under_block(), kGodObject);
  EXPECT_EQ(scene(support::tip_at({0.01, 0, 0.005})).f_T_W.norm(), 0);
  EXPECT_EQ(scene(support::tip_at({0.011, 0, 0.005})).f_T_W.norm(), 0);
  // Through the table from above, while still inside the block: the table is felt.
  EXPECT_GT(scene(support::tip_at({0.011, 0, -0.001})).f_T_W.z(), 0.7);
  scene(support::tip_at({0.011, 0, 0.02}));
  EXPECT_GT(scene(support::tip_at({0.011, 0, 0.014})).f_T_W.z(), 0.7);
}

TEST(World, ASolidInsideAnotherIsNeverFelt) {
  std::vector<SolidBlock> blocks{{.half = {0.01, 0.01, 0.01}}};
  SceneTouch one = scene_of(blocks, kGodObject);
  blocks.push_back({.half = {0.004, 0.004, 0.004}, .stiffness = 3000});
  SceneTouch nested = scene_of(blocks, kGodObject);
  for (int i = 0; i < 900; ++i) {
    const Vector3d p(0.001, 0.002, 0.011 - 1e-5 * i);
    ASSERT_EQ(one(support::tip_at(p)).f_T_W, nested(support::tip_at(p)).f_T_W) << i;
  }
}

TEST(World, ANanPositionEndsAllContacts) {
  SceneTouch scene = scene_of(under_block(), kGodObject);
  scene(support::tip_at({-0.001, 0, 0.001}));
  scene(support::tip_at({-0.001, 0, -0.001}));
  EXPECT_GT(scene(support::tip_at({0.001, 0, -0.001})).f_T_W.norm(), 1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(scene(support::tip_at({nan, 0, 0})).f_T_W, Vector3d(0, 0, 0));
  EXPECT_EQ(scene(support::tip_at({-0.001, 0, -0.001})).f_T_W, Vector3d(0, 0, 0));
  scene(support::tip_at({-0.001, 0, 0.1}));
  scene(support::tip_at({0.001, 0, 0.1}));
  EXPECT_GT(scene(support::tip_at({0.001, 0, 0.0145})).f_T_W.z(), 0.3);
}

TEST(World, TicksAllocateNothing) {
  for (const TrackerChoice tracker : support::kTrackers) {
    SceneTouch scene = scene_of(under_block(), {.tracker = tracker});
    Random random(100);
    Vector3d p(-0.005, 0, 0.01);
    const int calls = support::heap_calls_of([&] {
      for (int i = 0; i < 20'000; ++i) {
        p += 2e-4 * random.in_box(1);
        p = p.cwiseMax(-0.012).cwiseMin(0.012);
        scene.prepare(support::tip_at(p));
        scene(support::tip_at(p));
      }
    });
    EXPECT_EQ(calls, 0) << support::scene_name(tracker);
  }
}

/// Work that the scene does on a tip along a closed loop, and the work that goes in.
struct Work {
  double sum = 0, in = 0;
};
template <class Path>
Work work_around(SceneTouch& scene, const Path& path, int steps) {
  Work work;
  Vector3d before = path(0.0);
  Vector3d f = scene(support::tip_at(before)).f_T_W;
  for (int i = 1; i <= steps; ++i) {
    const Vector3d p = path(static_cast<double>(i) / steps);
    const Vector3d f_now = scene(support::tip_at(p)).f_T_W;
    const double done = (f + f_now).dot(p - before) / 2;
    work.sum += done;
    work.in += std::max(0.0, -done);
    before = p;
    f = f_now;
  }
  return work;
}

TEST(World, AClosedLoopThroughACornerDoesNoWork) {
  for (const double stiffness : {kStiffness, 200.0}) {
    for (const double lean : {0.0, 0.4, -0.3}) {
      std::vector<SolidBlock> blocks = under_block();
      blocks[1].stiffness = stiffness;
      // The side stays on the line x = z = 0.
      blocks[1].R = Eigen::AngleAxisd(lean, Vector3d::UnitY()).toRotationMatrix();
      blocks[1].half.z() = 0.02;
      blocks[1].centre = blocks[1].R * Vector3d(0.015, 0, 0);
      SceneTouch scene = scene_of(blocks, kGodObject);
      scene(support::tip_at({-0.004, 0, 0.01}));
      const auto path = [](double t) {
        const double angle = 2 * std::numbers::pi * t + 2.4;
        return Vector3d(-0.0004 + 0.002 * std::cos(angle), 0.001 * std::sin(angle),
                        0.0004 + 0.002 * std::sin(angle));
      };
      const Work work = work_around(scene, path, 400'000);
      EXPECT_GT(work.in, 1e-4);
      EXPECT_LT(std::abs(work.sum), 1e-6 * work.in) << stiffness << ' ' << lean;
    }
  }
}

TEST(World, AClosedLoopThroughASeamDoesNoWork) {
  SceneTouch scene = scene_of(seam(), kGodObject);
  scene(support::tip_at({-0.004, 0, 0.01}));
  const auto path = [](double t) {
    const double angle = 2 * std::numbers::pi * t + 2.4;
    return Vector3d(0.002 * std::cos(angle), 0.001 * std::sin(angle),
                    0.0004 + 0.002 * std::sin(angle));
  };
  const Work work = work_around(scene, path, 400'000);
  EXPECT_GT(work.in, 1e-4);
  EXPECT_LT(std::abs(work.sum), 1e-6 * work.in);
}

TEST(World, ASeamBetweenSoftAndStiffGivesTheHandNoEnergy) {
  for (const TrackerChoice tracker : support::kTrackers) {
    for (const double direction : {1.0, -1.0}) {
      std::vector<SolidBlock> blocks = seam();
      blocks[1].stiffness = 2 * kStiffness;
      SceneTouch scene = scene_of(blocks, {.tracker = tracker});
      scene(support::tip_at({-0.004, 0, 0.01}));
      // Down on one side, along, and up on the other.
      const auto path = [=](double t) {
        const double angle = direction * 2 * std::numbers::pi * t + 2.4;
        return Vector3d(0.002 * std::cos(angle), 0.001 * std::sin(angle),
                        0.0004 + 0.002 * std::sin(angle));
      };
      const Work work = work_around(scene, path, 4000);
      EXPECT_GT(work.in, 1e-4);
      // The share that a lagging spring is given (ProxyFilter::kGift), of this path.
      EXPECT_LT(work.sum, 0.05 * work.in) << support::scene_name(tracker) << ' ' << direction;
    }
  }
}

TEST(World, ForceChangesByAtMostFiveKTimesThePath) {
  Random random(200);
  const int scenes = support::long_form() ? 2000 : 100;
  double most = 0;
  for (int i = 0; i < scenes; ++i) {
    std::vector<SolidBlock> blocks;
    for (int k = 0; k < 6; ++k) {
      blocks.push_back(
          {.centre = random.in_box(0.015),
           .half = Vector3d(0.012, 0.012, 0.012) + random.in_box(0.008),
           .R = Eigen::AngleAxisd(random.uniform(0, 3), random.direction()).toRotationMatrix(),
           .stiffness = random.uniform(200, 1500)});
    }
    double stiffest = 0;
    for (const SolidBlock& block : blocks) stiffest = std::max(stiffest, block.stiffness);
    const TrackerChoice tracker =
        support::kTrackers[static_cast<std::size_t>(i) % support::kTrackers.size()];
    SceneTouch scene = scene_of(blocks, {.tracker = tracker});
    Vector3d p(0, 0, 0.06), target = random.in_box(0.02);
    Vector3d f = scene(support::tip_at(p)).f_T_W;
    bool touched = false;
    for (int tick = 0; tick < 3000; ++tick) {
      if (random.uniform(0, 1) < 0.01) target = random.in_box(0.03);
      const Vector3d before = p;
      p += random.uniform(0, 3e-4) * (target - p).normalized() + 1e-5 * random.in_box(1);
      const driver::ForceCommand now = scene(support::tip_at(p));
      // Where contact ends, the force is zero at once.
      if (touched && now.touch.in_contact) {
        const double ratio = (now.f_T_W - f).norm() / (stiffest * (p - before).norm());
        most = std::max(most, ratio);
        ASSERT_LT(ratio, 5 + 1e-6) << i << ' ' << tick << ' ' << support::scene_name(tracker);
      }
      ASSERT_TRUE(now.f_T_W.allFinite());
      touched = now.touch.in_contact;
      f = now.f_T_W;
    }
  }
  EXPECT_GT(most, 1);
}

TEST(World, AFastTipDoesNotPassThinPlates) {
  std::vector<SolidBlock> blocks;
  for (int i = 0; i < 4; ++i) {
    blocks.push_back({.centre = {0.02 * i - 0.03, 0, 0}, .half = {0.0101, 0.04, 0.0001}});
  }
  for (const TrackerChoice tracker : support::kTrackers) {
    SceneTouch scene = scene_of(blocks, {.tracker = tracker});
    Random random(500);
    for (int stroke = 0; stroke < 500; ++stroke) {
      Vector3d p(random.uniform(-0.035, 0.035), random.uniform(-0.03, 0.03), 0.004);
      scene(support::tip_at({0, 0, 0.1}));
      scene(support::tip_at(p));
      // Down at 2 m/s, then along the seams.
      const Vector3d way(random.uniform(-0.001, 0.001), random.uniform(-0.001, 0.001), -0.002);
      for (int i = 0; i < 4; ++i) scene(support::tip_at(p += way));
      const driver::ForceCommand held = scene(support::tip_at(p));
      EXPECT_GT(held.f_T_W.z(), 0) << support::scene_name(tracker) << p.transpose();
      EXPECT_GT(scene.world()->proxy().z(), 0) << support::scene_name(tracker);
    }
  }
}

}  // namespace
}  // namespace thimble::render
