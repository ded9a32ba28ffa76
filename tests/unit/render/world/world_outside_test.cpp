// The proxy stays outside of rough solids that overlap, whatever moves it over them.

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "support/meshes/shapes.h"
#include "support/meshes/solid_triangles.h"
#include "support/random.h"
#include "support/tip_at.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/scene_touch.h"
#include "world/contact_world.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;
using support::Random;

/// What a walk of a tip has found.
struct Walk {
  double inside = 0;  ///< Greatest depth of the proxy in a solid, with the radius of the tip; m.
  int lost = 0;       ///< Ticks with the tip inside, and without contact.
  int contact = 0;    ///< Ticks in contact.
  int stays = 0;      ///< Greatest number of ticks in a row that did not settle.
  int steps_max = 0;  ///< Greatest number of steps of a ball in a tick.
};

/// Leads a tip through three overlapping stars.
Walk walk(const ContactChoice& choice, std::uint64_t seed) {
  std::vector<TriangleMesh> meshes;
  std::vector<std::unique_ptr<ObjectTouch>> touches;
  for (const Vector3d& middle :
       {Vector3d(0, 0, 0), Vector3d(0.012, 0.003, 0), Vector3d(0.004, 0.013, 0.004)}) {
    TriangleMesh mesh = support::bumpy_sphere(3, 0.01, 0.3, 7);
    for (Vector3d& p : mesh.vertices) p += middle;
    meshes.push_back(mesh);
    touches.push_back(build_object_touch(mesh, choice, {.spring = {.stiffness = 800}}).value());
  }
  SceneTouch scene(std::move(touches));
  const support::SolidTriangles triangles(meshes);
  Random random(seed);
  Walk found;
  Vector3d p(0, 0, 0.03), goal = p, heading = random.direction();
  scene(support::tip_at(p));
  auto unsettled = scene.world()->counters().unsettled;
  int stays = 0;
  for (int tick = 0; tick < 6000; ++tick) {
    if ((goal - p).norm() < 0.002) goal = Vector3d(0.005, 0.005, 0) + random.in_box(0.016);
    heading = (heading + 0.15 * random.direction() + 0.05 * (goal - p).normalized()).normalized();
    p += 3e-4 * heading;
    scene(support::tip_at(p));
    const Vector3d& q = scene.world()->proxy();
    const bool touching = scene.world()->active_count() > 0;
    found.contact += touching ? 1 : 0;
    stays = scene.world()->counters().unsettled > unsettled ? stays + 1 : 0;
    found.stays = std::max(found.stays, stays);
    unsettled = scene.world()->counters().unsettled;
    const double distance = triangles.distance(q);
    const double depth = triangles.inside(q) ? choice.tip_radius + distance
                                             : std::max(0.0, choice.tip_radius - distance);
    found.inside = std::max(found.inside, depth);
    if (!touching && depth > 1e-9) ++found.lost;
  }
  found.steps_max = scene.world()->counters().steps_max;
  return found;
}

class WorldOutside : public testing::TestWithParam<ContactChoice> {};

TEST_P(WorldOutside, TheProxyEntersNoStarOfThree) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const Walk found = walk(GetParam(), seed);
    EXPECT_LT(found.inside, 1e-9) << seed;
    EXPECT_EQ(found.lost, 0) << seed;
    EXPECT_GT(found.contact, 1000) << seed;
    // A proxy that stays for longer is felt as stuck.
    EXPECT_LT(found.stays, 100) << seed;
    // The bound of a world, and one round of three balls more.
    EXPECT_LT(found.steps_max, 256 + 3 * 32) << seed;
  }
}

INSTANTIATE_TEST_SUITE_P(Ways, WorldOutside,
                         testing::Values(ContactChoice{.tracker = TrackerChoice::kGodObject},
                                         ContactChoice{.tracker = TrackerChoice::kEdgePlanes},
                                         ContactChoice{.tracker = TrackerChoice::kGodObject,
                                                       .tip_radius = 0.002}));

}  // namespace
}  // namespace thimble::render
