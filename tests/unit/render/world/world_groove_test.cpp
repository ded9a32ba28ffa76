// A groove of one mesh that ends at another object: three planes of two solids.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <vector>

#include "support/box_union.h"
#include "support/meshes/concave_solids.h"
#include "support/tip_at.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/scene_touch.h"
#include "world/active_planes.h"
#include "world/contact_world.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::SolidBlock;

// The point is far outside of the first plane and below the second, which faces away from it.
TEST(PushOut, PlaneFromWhichAPointIsOutsideDoesNotPull) {
  const double slope = std::sqrt(0.75);
  const std::array<ActivePlane, 2> planes{ActivePlane{{0, 0, 1}, -10},
                                          ActivePlane{{slope, 0, -0.5}, 1}};
  for (const auto& order : {planes, std::array{planes[1], planes[0]}}) {
    const PushOut push = push_out(order, {0, 0, 0}, 0, 1e-15);
    EXPECT_TRUE(push.feasible);
    EXPECT_LT((push.d - planes[1].n).norm(), 1e-14) << push.d.transpose();
  }
}

TEST(WorldGroove, AWallAcrossAGrooveMakesACornerOfThreePlanes) {
  constexpr double kLeft = 0.5, kRight = 0.7, kStiffness = 800;
  const support::ConcaveSolid groove =
      support::groove(kLeft, kRight, 0.03, 0.03, {-0.03, -0.01, 0.0005, 0.01, 0.03});
  for (const Vector3d& lean :
       {Vector3d(0, -1, 0), Vector3d(0.2, -1, 0.3), Vector3d(-0.3, -1, -0.2)}) {
    const Vector3d n = lean.normalized();
    SolidBlock wall{.half = {0.03, 0.02, 0.03}};
    wall.R = Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitY(), -n).toRotationMatrix();
    wall.centre = Vector3d(0, 0.004, 0) - 0.02 * n;
    std::vector<std::unique_ptr<ObjectTouch>> objects;
    objects.push_back(build_object_touch(groove.mesh, {.tracker = TrackerChoice::kGodObject},
                                         {.spring = {.stiffness = kStiffness}})
                          .value());
    objects.push_back(build_object_touch(wall.mesh(), {.tracker = TrackerChoice::kGodObject},
                                         {.spring = {.stiffness = kStiffness}})
                          .value());
    SceneTouch scene(std::move(objects));
    const std::array<ActivePlane, 3> planes{
        ActivePlane{{std::sin(kLeft), 0, std::cos(kLeft)}, 0},
        ActivePlane{{-std::sin(kRight), 0, std::cos(kRight)}, 0}, ActivePlane{n, n.y() * 0.004}};
    double off = 0, force_off = 0;
    int corner = 0;
    for (int i = 0; i < 4000; ++i) {
      const double t = 1e-3 * i;
      const Vector3d p(0.0004 * std::sin(3 * t), std::min(-0.006 + 0.005 * t, 0.008),
                       std::max(0.004 - 0.006 * t, -0.001) + 0.0003 * std::sin(5 * t));
      const driver::ForceCommand command = scene(support::tip_at(p));
      const PushOut exact = push_out(planes, p, 0, 1e-15);
      off = std::max(off, (scene.world()->proxy() - p - exact.d).norm());
      force_off = std::max(force_off, (command.f_T_W - kStiffness * exact.d).norm());
      corner += exact.lambda[0] > 0 && exact.lambda[1] > 0 && exact.lambda[2] > 0 ? 1 : 0;
    }
    EXPECT_GT(corner, 100) << lean.transpose();
    EXPECT_LT(off, 1e-9 * 0.05) << lean.transpose();
    EXPECT_LT(force_off, 1e-6) << lean.transpose();
    EXPECT_EQ(scene.world()->counters().unsettled, 0u);
  }
}

}  // namespace
}  // namespace thimble::render
