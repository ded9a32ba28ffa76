// Parts of one mesh that overlap.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "body/motion/move_object.h"
#include "mesh/overlapping_parts.h"
#include "support/box_union.h"
#include "support/meshes/shapes.h"
#include "support/tip_at.h"
#include "support/tracker_names.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/scene_touch.h"
#include "world/contact_world.h"
#include "world_solid.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::SolidBlock;

void append(const TriangleMesh& part, TriangleMesh& whole) {
  const auto first = static_cast<std::int32_t>(whole.vertices.size());
  whole.vertices.insert(whole.vertices.end(), part.vertices.begin(), part.vertices.end());
  for (auto corners : part.triangles) {
    for (std::int32_t& corner : corners) corner += first;
    whole.triangles.push_back(corners);
  }
}

TriangleMesh turned(TriangleMesh mesh) {
  for (auto& corners : mesh.triangles) std::swap(corners[0], corners[1]);
  return mesh;
}

/// A post that is in a base, as in post_one_mesh.yaml: the base's top at z = 0.
const SolidBlock kBase{.centre = {0, 0, -0.01}, .half = {0.03, 0.03, 0.01}};
const SolidBlock kPost{.centre = {0, 0, 0.005}, .half = {0.005, 0.03, 0.01}};

TriangleMesh post_mesh() {
  TriangleMesh mesh;
  append(kBase.mesh(), mesh);
  append(kPost.mesh(), mesh);
  return mesh;
}

SceneTouch one_object(const TriangleMesh& mesh, TrackerChoice tracker) {
  std::vector<std::unique_ptr<ObjectTouch>> objects;
  objects.push_back(
      build_object_touch(mesh, {.tracker = tracker}, {.spring = {.stiffness = 800}}).value());
  return SceneTouch(std::move(objects));
}

TEST(OverlappingParts, AreThoseWhoseBoxesOverlap) {
  EXPECT_TRUE(overlapping_parts(support::box({1, 1, 1})).empty());
  const auto parts = overlapping_parts(post_mesh());
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].triangles.size(), 12u);
  EXPECT_EQ(parts[1].triangles.front(), 12);
  // Two solids apart stay one part, beside two that overlap.
  TriangleMesh more = post_mesh();
  for (const double x : {0.2, 0.3}) {
    append(SolidBlock{.centre = {x, 0, 0}, .half = {0.01, 0.01, 0.01}}.mesh(), more);
  }
  ASSERT_EQ(overlapping_parts(more).size(), 3u);
  EXPECT_EQ(overlapping_parts(more)[0].triangles.size(), 24u);
}

TEST(OverlappingParts, KeepACavityWithItsSolid) {
  TriangleMesh mesh;
  append(support::box({0.01, 0.01, 0.01}), mesh);
  append(turned(support::box({0.006, 0.006, 0.006})), mesh);
  EXPECT_TRUE(overlapping_parts(mesh).empty());
  append(SolidBlock{.centre = {0.012, 0, 0}, .half = {0.004, 0.004, 0.004}}.mesh(), mesh);
  const auto parts = overlapping_parts(mesh);
  ASSERT_EQ(parts.size(), 2u);
  EXPECT_EQ(parts[0].triangles.size(), 24u);
}

TEST(WorldParts, AreFeltAsSeveralObjectsAre) {
  for (const TrackerChoice tracker : support::kTrackers) {
    SceneTouch one = one_object(post_mesh(), tracker);
    SceneTouch two = support::scene_of({kBase, kPost}, {.tracker = tracker});
    double side = 0;
    for (int i = 0; i < 2500; ++i) {
      const Vector3d p(-0.015 + 1e-5 * std::max(0, i - 900), 0.001,
                       std::max(-0.003, 0.004 - 1e-5 * i));
      const driver::ForceCommand a = one(support::tip_at(p)), b = two(support::tip_at(p));
      ASSERT_EQ(a.f_T_W, b.f_T_W) << support::scene_name(tracker) << ' ' << i;
      if (a.touch.in_contact) {
        ASSERT_EQ(a.touch.object, 0);
        ASSERT_EQ(a.touch.feature, b.touch.feature + (b.touch.object == 1 ? 12 : 0)) << i;
      }
      side = std::min(side, a.f_T_W.x());
    }
    EXPECT_LT(side, -2) << support::scene_name(tracker);
  }
}

TEST(WorldParts, AreFeltOnABodyThatMoves) {
  const TriangleMesh mesh = post_mesh();
  auto object = build_object_touch(mesh, {.tracker = TrackerChoice::kGodObject},
                                   {.spring = {.stiffness = 800}});
  std::vector<std::unique_ptr<ObjectTouch>> objects;
  objects.push_back(
      move_object(std::move(object).value(), mesh, {.mass = 0.5, .damping = 2}, {.stiffness = 800})
          .value());
  SceneTouch scene(std::move(objects));
  for (int i = 0; i < 2500; ++i) {
    scene(support::tip_at(
        {-0.015 + 1e-5 * std::max(0, i - 900), 0.001, std::max(-0.003, 0.004 - 1e-5 * i)}));
  }
  EXPECT_GT(scene.object(0).pose().p_WB[0], 0.003);
}

TEST(WorldParts, OneSettingSetsAllParts) {
  auto object = build_object_touch(post_mesh(), {}, {.spring = {.stiffness = 800}}).value();
  LiveSettings settings(2000, 10);
  object->list_settings(settings);
  ASSERT_EQ(settings.list().size(), 2u);
  settings.list()[0].set(settings.list()[0].stage, 400);
  for (WorldSolid* solid : object->solids()) EXPECT_EQ(solid->stiffness(), 400);
}

}  // namespace
}  // namespace thimble::render
