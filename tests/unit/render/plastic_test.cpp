#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "body/shape/movement_limits.h"
#include "body/shape/plastic_base.h"
#include "support/hard_case.h"
#include "support/random.h"
#include "support/shapes.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kTick = 1e-3;

struct Press {
  double work = 0;      // J, done by the finger
  double stiffest = 0;  // N/m, while it goes in and the base point holds
};

// Presses a fingertip down to `depth` and lifts it; it only pushes. From where the base point is.
Press press(PlasticBase& base, const Vector3d& inward, double depth, int ticks,
            double step = kTick) {
  Press told;
  double force = 0;
  double before = 0;
  for (int i = 1; i <= 2 * ticks; ++i) {
    const double share = 1 - std::abs(1 - static_cast<double>(i) / ticks);
    const double way = depth * share;
    const Vector3d tip = way * inward;
    const Vector3d held = base.displacement();
    const bool pushes = way > held.dot(inward);
    if (pushes) base.pull(tip, step);
    const double now = pushes ? -base.force(tip).dot(inward) : 0.0;
    if (pushes && i <= ticks && base.displacement() == held && way > held.dot(inward) + 1e-9) {
      told.stiffest = now / (way - held.dot(inward));
    }
    told.work += (force + now) / 2 * (way - before);
    force = now;
    before = way;
  }
  return told;
}

// The law: set = x_max - F_y / k, heat = F_y set, the second press follows k.
TEST(HardCase34, PlasticBaseKeepsWhatTheLawSays) {
  const PlasticSettings clay{.stiffness = 800, .yield_force = 1.5};
  const Vector3d inward(0.6, 0, -0.8);
  PlasticBase base(clay);
  const double depth = 7e-3;
  const Press first = press(base, inward, depth, 4000);
  const double set = depth - 1.5 / 800;
  EXPECT_NEAR(base.displacement().norm(), set, 1e-9);
  EXPECT_NEAR(base.dissipated(), 1.5 * set, 1e-9);
  EXPECT_NEAR(first.work, 1.5 * set, 1e-6);
  EXPECT_NEAR(first.stiffest, 800, 1e-6);
  // Less deep than before: nothing but the spring, from the set on.
  const Press second = press(base, inward, depth - 0.5e-3, 4000);
  EXPECT_NEAR(second.stiffest, 800, 1e-6);
  EXPECT_NEAR(second.work, 0, 1e-6);
  EXPECT_NEAR(base.displacement().norm(), set, 1e-12);
  support::record_hard_case(34, "second press on the set", "<= error of its stiffness",
                            std::abs(second.stiffest / 800 - 1), 1e-6, "1");
  // A little deeper: the set grows by as much.
  press(base, inward, depth + 1e-3, 4000);
  EXPECT_NEAR(base.displacement().norm(), set + 1e-3, 1e-9);
}

TEST(PlasticBase, SpringsBackWhollyBelowItsYieldForce) {
  PlasticBase base({.stiffness = 800, .yield_force = 1.5});
  const Press told = press(base, {0, 0, -1}, 0.999 * 1.5 / 800, 500);
  EXPECT_EQ(base.displacement().norm(), 0);
  EXPECT_EQ(base.dissipated(), 0);
  EXPECT_NEAR(told.work, 0, 1e-12);
}

// Of any depth and speed into clays of all sorts.
TEST(HardCase34, PlasticBaseObeysTheLawAndTakesWorkInAThousandRandomPresses) {
  double worst = 0, least = 0;
  support::Random random(34);
  for (int clay = 0; clay < 50; ++clay) {
    PlasticSettings settings;
    settings.stiffness = std::pow(10, random.uniform(1, 5));
    settings.yield_force = random.uniform(0, 5);
    const Vector3d inward = random.direction();
    PlasticBase base(settings);
    double deepest = 0;
    double heat = 0;
    for (int i = 0; i < 20; ++i) {
      const double depth =
          random.uniform(0, 3) * std::max(settings.yield_force / settings.stiffness, 1e-4);
      const Press told = press(base, inward, depth, 50);
      deepest = std::max(deepest, depth);
      const double set = std::max(deepest - settings.yield_force / settings.stiffness, 0.0);
      ASSERT_NEAR(base.displacement().dot(inward), set, 1e-9);
      ASSERT_NEAR(base.displacement().norm(), set, 1e-9);
      ASSERT_GE(base.dissipated(), heat);
      heat = base.dissipated();
      ASSERT_NEAR(heat, settings.yield_force * set, 1e-9 * (1 + heat));
      ASSERT_GE(told.work, -1e-12);
      worst = std::max(worst, std::abs(base.displacement().norm() - set));
      least = std::min(least, told.work);
    }
  }
  support::record_hard_case(34, "1000 presses, 50 clays", "<= error of the set", worst, 1e-9, "m");
  support::record_hard_case(34, "the same", "<= work given back by a press", -least, 1e-12, "J");
}

TEST(PlasticBase, NeverGivesEnergyWhereverItIsPulled) {
  support::Random random(35);
  for (int i = 0; i < 200; ++i) {
    PlasticSettings settings;
    settings.stiffness = 1000;
    settings.yield_force = random.uniform(0, 2);
    if (i % 2 == 0) settings.flow_rate = random.uniform(1e-3, 1);
    if (i % 3 == 0) settings.movement_limit = random.uniform(0, 3e-3);
    PlasticBase base(settings);
    Vector3d x(0, 0, 0);
    double given = 0;
    for (int tick = 0; tick < 200; ++tick) {
      // The vertex moves in a straight line while the base point holds, then the base point yields.
      const Vector3d to = random.in_box(5e-3);
      given -= (base.force(x) + base.force(to)).dot(to - x) / 2;
      x = to;
      const Vector3d before = base.displacement();
      const double heat = base.dissipated();
      const double stored = base.energy(x);
      base.pull(x, kTick);
      ASSERT_GE(base.dissipated(), heat);
      ASSERT_LE(base.energy(x) + base.dissipated() - heat, stored + 1e-15);
      ASSERT_LE(base.displacement().norm(), settings.movement_limit * (1 + 1e-12));
      ASSERT_LE((base.displacement() - before).norm(), settings.flow_rate * kTick * (1 + 1e-9));
    }
    ASSERT_GE(given, base.dissipated() - 1e-12);
  }
}

TEST(PlasticBase, FlowsNoFasterThanItMay) {
  PlasticBase base({.stiffness = 1000, .yield_force = 1, .flow_rate = 2e-3});
  for (int tick = 0; tick < 1000; ++tick) base.pull({0, 0, -9e-3}, kTick);
  EXPECT_NEAR(base.displacement().z(), -2e-3, 1e-9);
  for (int tick = 0; tick < 5000; ++tick) base.pull({0, 0, -9e-3}, kTick);
  EXPECT_NEAR(base.displacement().z(), -8e-3, 1e-9);
}

TEST(PlasticBase, StaysOnNonsense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  PlasticBase base({.stiffness = 1000, .yield_force = 1});
  base.pull({nan, 0, 0}, kTick);
  base.pull({inf, 0, 0}, kTick);
  base.pull({1, 0, 0}, nan);
  base.pull({1, 0, 0}, -1);
  EXPECT_EQ(base.displacement().norm(), 0);
  for (const PlasticSettings bad : {PlasticSettings{nan, 1},
                                    {-1, 1},
                                    {0, 1},
                                    {inf, 1},
                                    {1e3, -1},
                                    {1e3, nan},
                                    {1e3, 1, 0},
                                    {1e3, 1, nan},
                                    {1e3, 1, 1, -1},
                                    {1e3, 1, 1, nan}}) {
    PlasticBase refused(bad);
    refused.pull({1, 0, 0}, kTick);
    EXPECT_EQ(refused.displacement().norm(), 0);
  }
  PlasticBase hard({.stiffness = 1e12, .yield_force = 1});
  hard.pull({1, 0, 0}, kTick);
  EXPECT_NEAR(hard.displacement().x(), 1, 1e-9);
}

// That the mesh never inverts: as far as limits on movement can promise it.
TEST(HardCase34, MovementLimitsKeepEveryTriangleOnItsSide) {
  double least = 1;
  support::Random random(36);
  TriangleMesh mesh = support::icosphere(2, 0.03);
  for (Vector3d& p : mesh.vertices) p += random.in_box(1e-3);
  const std::vector<double> limits = movement_limits(mesh);
  for (int round = 0; round < 300; ++round) {
    TriangleMesh moved = mesh;
    for (std::size_t v = 0; v < limits.size(); ++v) {
      ASSERT_GT(limits[v], 0);
      moved.vertices[v] += limits[v] * random.direction();
    }
    for (const auto& triangle : mesh.triangles) {
      const auto normal = [&](const TriangleMesh& of) {
        const auto at = [&](std::size_t k) {
          return of.vertices[static_cast<std::size_t>(triangle[k])];
        };
        return (at(1) - at(0)).cross(at(2) - at(0)).eval();
      };
      ASSERT_GT(normal(mesh).dot(normal(moved)), 0);
      least = std::min(least, normal(mesh).dot(normal(moved)) / normal(mesh).squaredNorm());
    }
  }
  support::record_hard_case(34, "all vertices moved at random to their limits",
                            "> least area seen from outside, of the first", least, 0, "1");
}

}  // namespace
}  // namespace thimble::render
