#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "body/shape/snap_base.h"
#include "body/shape/snap_truss.h"
#include "support/hard_case.h"
#include "support/random.h"

namespace thimble::render {
namespace {

// Truss of [PHYSICS 4], which states its limit load, stiffnesses and energies.
constexpr SnapSettings kStated{
    .half_span = 20e-3, .rise = 6e-3, .bar_stiffness = 5000, .speed_max = 1e9};

SnapBase stated_base() {
  return {kStated, Eigen::Vector3d(0, 0, -1)};
}

TEST(SnapTruss, HasTheStatedLimitLoadStiffnessesAndBarrier) {
  const SnapTruss truss(20e-3, 6e-3, 5000);
  ASSERT_TRUE(truss.limit_point());
  EXPECT_NEAR(*truss.limit_point(), 2.58577e-3, 1e-8);
  EXPECT_NEAR(truss.limit_load(), 0.994992, 1e-6);
  EXPECT_NEAR(truss.stiffness(0), 825.7, 0.05);
  EXPECT_NEAR(truss.stiffness(6e-3), -440.3, 0.05);
  EXPECT_NEAR(truss.energy(6e-3), 3.877e-3, 1e-6);
  EXPECT_EQ(truss.force(0), 0);
  EXPECT_NEAR(truss.force(12e-3), 0, 1e-12);
  // Force and stiffness are the derivatives of energy and force.
  support::Random random(32);
  for (int i = 0; i < 200; ++i) {
    const double u = random.uniform(-5e-3, 18e-3);
    const double d = 1e-7;
    EXPECT_NEAR(truss.force(u), (truss.energy(u + d) - truss.energy(u - d)) / (2 * d), 1e-6);
    EXPECT_NEAR(truss.stiffness(u), (truss.force(u + d) - truss.force(u - d)) / (2 * d), 1e-2);
  }
}

TEST(SnapTruss, SettlesWhereForcesAreEqual) {
  support::Random random(33);
  int found = 0;
  for (int i = 0; i < 20000; ++i) {
    const SnapTruss truss{random.uniform(5e-3, 30e-3), random.uniform(1e-4, 20e-3),
                          std::pow(10, random.uniform(1, 6))};
    const double spring = i % 2 == 0 ? 0 : std::pow(10, random.uniform(0, 7));
    const double load =
        truss.limit_load() * random.uniform(-2, 2) + spring * random.uniform(0, 0.02);
    const bool snapped = i % 3 == 0;
    const auto u = truss.settle(load, spring, snapped);
    if (!u) continue;
    ++found;
    const double scale = std::abs(load) + truss.limit_load() + spring * truss.rise();
    EXPECT_NEAR(truss.force(*u) + spring * *u, load, 1e-11 * scale);
    EXPECT_GE(truss.stiffness(*u) + spring, -1e-6 * (truss.stiffness(0) + spring));
  }
  EXPECT_GT(found, 10000);
}

// Under a growing load.
TEST(HardCaseSnapThrough, SnapsOnceEachWay) {
  using support::record_hard_case;
  SnapBase base = stated_base();
  double load = 0;
  const double step = 2e-5;
  double way_before = 0;
  while (base.snaps() == 0 && load < 2) {
    way_before = base.way();
    base.pull_by_load(load += step, 1e-3);
  }
  EXPECT_NEAR(load, 0.994992, 0.005 * 0.994992);
  EXPECT_NEAR(way_before, 2.58577e-3, 0.005 * 2.58577e-3);
  EXPECT_NEAR(base.way(), 12.979e-3, 0.005 * 12.979e-3);
  EXPECT_NEAR(base.released(), 11.63e-3, 0.02 * 11.63e-3);
  EXPECT_TRUE(base.snapped());
  const char* const kLoad = "under a growing load";
  record_hard_case(32, kLoad, "<= error of the limit load", std::abs(load / 0.994992 - 1), 0.005,
                   "1");
  record_hard_case(32, kLoad, "<= error of the way there", std::abs(way_before / 2.58577e-3 - 1),
                   0.005, "1");
  record_hard_case(32, kLoad, "<= error of the energy released",
                   std::abs(base.released() / 11.63e-3 - 1), 0.02, "1");
  // Without load it rests in its new shape.
  for (; load > 0; load -= 1e-4) base.pull_by_load(load, 1e-3);
  base.pull_by_load(0, 1e-3);
  EXPECT_EQ(base.snaps(), 1);
  EXPECT_NEAR(base.way(), 12e-3, 1e-9);
  while (base.snaps() == 1 && load > -2) base.pull_by_load(load -= step, 1e-3);
  EXPECT_NEAR(load, -0.994992, 0.005 * 0.994992);
  EXPECT_EQ(base.snaps(), 2);
  record_hard_case(32, "in and out again", "== snaps", static_cast<double>(base.snaps()), 2, "1");
  EXPECT_NEAR(base.released(), 2 * 11.63e-3, 0.02 * 2 * 11.63e-3);
}

// The vertex is driven in and out: the loop through its own spring.
TEST(HardCaseSnapThrough, LoopRepeatsAndWorkIsAccounted) {
  double worst = 0;
  constexpr double kSpring = 200;  // softer than the truss's steepest slope, so that it jumps
  constexpr double kIn = 25e-3;
  SnapBase base = stated_base();
  constexpr int kTicks = 20000;
  std::vector<double> first;
  double first_loop = 0;
  for (int loop = 0; loop < 4; ++loop) {
    double work = 0;
    double force = kSpring * -base.way();
    const double released = base.released();
    const auto snaps = base.snaps();
    std::vector<double> forces;
    double before = 0;
    for (int i = 1; i <= 2 * kTicks; ++i) {
      const double share = 1 - std::abs(1 - static_cast<double>(i) / kTicks);  // 0 to 1, and back
      const double way = -13e-3 + (kIn + 13e-3) * share;
      if (i == 1) before = way;
      base.pull_by_spring(way, kSpring, 1e-3);
      const double now = kSpring * (way - base.way());
      work += (force + now) / 2 * (way - before);
      force = now;
      before = way;
      forces.push_back(now);
    }
    if (loop == 0) continue;  // the first begins at another place
    EXPECT_EQ(base.snaps(), snaps + 2);
    EXPECT_NEAR(work, base.released() - released, 1e-3 * work);
    if (loop == 1) {
      first = forces;
      first_loop = work;
      continue;
    }
    EXPECT_NEAR(work, first_loop, 1e-6 * first_loop);
    worst = std::max(worst, std::abs(work / first_loop - 1));
    for (std::size_t i = 0; i < first.size(); ++i) ASSERT_NEAR(forces[i], first[i], 1e-6);
  }
  EXPECT_GT(first_loop, 0);
  support::record_hard_case(32, "driven in and out by a soft spring, three loops",
                            "<= difference of their work", worst, 1e-6, "1");
}

// Displacement control: driven stiffly it never jumps, and the force follows the law.
TEST(HardCaseSnapThrough, StiffDriveFollowsTheLaw) {
  constexpr double kSpring = 1e6;
  SnapBase base = stated_base();
  double most = 0;
  double at = 0;
  double before = 0;
  for (double way = 0; way < 14e-3; way += 1e-6) {
    base.pull_by_spring(way, kSpring, 1e-3);
    const double force = kSpring * (way - base.way());
    EXPECT_NEAR(force, base.truss().force(base.way()), 1e-6);
    EXPECT_LT(std::abs(base.way() - before), 2e-6);
    before = base.way();
    if (base.way() < 6e-3 && force > most) {
      most = force;
      at = base.way();
    }
  }
  EXPECT_NEAR(most, 0.994992, 0.005 * 0.994992);
  EXPECT_NEAR(at, 2.58577e-3, 0.005 * 2.58577e-3);
  EXPECT_EQ(base.released(), 0);
  support::record_hard_case(32, "by displacement", "<= error of the limit load",
                            std::abs(most / 0.994992 - 1), 0.005, "1");
  support::record_hard_case(32, "by displacement", "<= error of the way there",
                            std::abs(at / 2.58577e-3 - 1), 0.005, "1");
}

TEST(SnapBase, SpeedLimitKeepsTheReleasedEnergy) {
  SnapSettings slow = kStated;
  slow.speed_max = 0.5;
  SnapBase base(slow, {0, 0, -1});
  for (double load = 0; load < 0.9949; load += 1e-4) base.pull_by_load(load, 1e-3);
  EXPECT_EQ(base.snaps(), 0);
  int ticks = 0;
  double before = 0;
  do {
    before = base.way();
    base.pull_by_load(0.99500, 1e-3);
    EXPECT_LE(base.way() - before, 0.5e-3 + 1e-12);
    ++ticks;
  } while (base.way() != before);
  EXPECT_GT(ticks, 20);
  EXPECT_NEAR(base.released(), 11.63e-3, 0.02 * 11.63e-3);
  EXPECT_EQ(base.displacement(), base.way() * Eigen::Vector3d(0, 0, -1));
}

TEST(SnapBase, IgnoresInvalidInput) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  SnapBase base = stated_base();
  for (const double bad : {nan, inf, -inf}) {
    base.pull_by_load(bad, 1e-3);
    base.pull_by_spring(bad, 100, 1e-3);
    base.pull_by_spring(1e-3, bad, 1e-3);
    base.pull_by_load(0.5, nan);
  }
  base.pull_by_spring(1e-3, -5, 1e-3);
  EXPECT_EQ(base.way(), 0);
  for (const double bad : {nan, inf, 0.0, -1.0}) {
    SnapBase flat({bad, 6e-3, 5000, 1}, {0, 0, -1});
    EXPECT_FALSE(flat.truss().valid());
    flat.pull_by_load(5, 1e-3);
    EXPECT_EQ(flat.way(), 0);
    EXPECT_EQ(flat.snaps(), 0);
  }
  SnapBase hard({20e-3, 6e-3, 1e12, 1e9}, {0, 0, -1});
  hard.pull_by_load(1e6, 1e-3);
  EXPECT_TRUE(std::isfinite(hard.way()));
}

}  // namespace
}  // namespace thimble::render
