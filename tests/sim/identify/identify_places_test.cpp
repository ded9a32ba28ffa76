// Links of a serial arm from its motion at several places.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bringup/identify/link_inertia/link_fit.h"
#include "bringup/identify/link_inertia/sweep_workspace.h"
#include "bringup/identify/record_motion.h"
#include "support/identify/identified_arm.h"
#include "support/linked_arm.h"
#include "support/long_form.h"
#include "support/random.h"

namespace thimble::bringup {
namespace {

using support::hidden_arm;
using support::HiddenArm;
using support::linked_arm;
using support::long_form;
using support::tip_masses;

/// Fits the recorded motions of an arm at several places.
driver::Result<LinkFit> fitted(const HiddenArm& arm, std::uint64_t seed, double seconds, int places,
                               double max_force = kIdentifyForceMax) {
  const std::atomic<bool> never{false};
  auto bench = simulated_bench(arm.file, 0, false, max_force);
  if (!bench) return bench.error();
  double most = 0;
  int outside = 0, pushed = 0;
  (*bench)->watch([&](const driver::TickRecord& tick) {
    const double force = Eigen::Vector3d(tick.f_wanted_W.data()).norm();
    most = std::max(most, force);
    pushed += force > 0 ? 1 : 0;
    const bool is_outside = !arm.file.workspace.holds(Eigen::Vector3d(tick.p_WT.data()));
    outside += force > 0 && is_outside ? 1 : 0;
  });
  const auto motions = record_at_points(
      **bench, arm.file, {.seconds = seconds, .lead = 0.5, .max_force = max_force, .seed = seed},
      sweep_points(arm.file, places), never);
  EXPECT_LE(most, max_force);
  EXPECT_EQ(outside, 0);
  EXPECT_GT(pushed, 1000);
  EXPECT_TRUE((*bench)->device().zero_assured());
  if (!motions) return motions.error();
  return fit_links(std::get<driver::SerialArm>(arm.file.model.geometry), *motions);
}

/// Adds errors of the apparent mass at places without motion, over the whole workspace. `range`:
/// min. and max. mass.
void look_between(const HiddenArm& arm, const LinkFit& found, double scale, std::uint64_t seed,
                  support::Score& score, std::pair<double, double>& range) {
  support::Random random(seed + 900);
  const auto& build = std::get<driver::SerialArm>(arm.file.model.geometry);
  range = {HUGE_VAL, 0};
  for (int k = 0; k < 24;) {
    Eigen::Vector3d p_W;
    for (Eigen::Index i = 0; i < 3; ++i) {
      p_W[i] = random.uniform(arm.file.workspace.min_W[i], arm.file.workspace.max_W[i]);
    }
    if (!moves_easily(arm.file, p_W)) continue;
    ++k;
    const auto q = build.inverse(arm.file.R_WB.transpose() * (p_W - arm.file.p_WB));
    ASSERT_TRUE(q.has_value());
    const auto masses = found.apparent_mass(*q);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      const double mass = tip_masses(arm.file, *q)(axis, axis);
      score.add(masses[i], scale * mass);
      range = {std::min(range.first, mass), std::max(range.second, mass)};
    }
  }
}

double mean_of_gains(const HiddenArm& arm) {
  return std::cbrt(arm.gain[0] * arm.gain[1] * arm.gain[2]);
}

TEST(IdentifyPlaces, FindsTheMassAtUnvisitedPlaces) {
  support::Score score{"mass", 0.03};
  int held_places = 0, all_places = 0;
  // The last arms are four times as heavy: up to a kilogram, which 1 N hardly moves, so encoder
  // steps matter.
  const std::uint64_t first = long_form() ? 7000 : 7021, end = long_form() ? 7040 : 7022;
  for (std::uint64_t seed = first; seed < end; ++seed) {
    SCOPED_TRACE(seed);
    HiddenArm arm = linked_arm(seed);
    if (seed >= 7020) {
      auto& links = arm.file.simulated.links;
      links.inertia *= 4, links.yaw_b *= 4, links.yaw_c *= 4, links.coupling *= 4;
    }
    const auto found = fitted(arm, seed, long_form() ? 5 : 2, 7);
    ASSERT_TRUE(found.ok()) << found.error().message;
    EXPECT_TRUE(found->links) << found->better;
    support::Score one{"mass", 0.03};
    std::pair<double, double> range;
    // Without a known mass the mean gain sets the scale.
    look_between(arm, *found, 1 / mean_of_gains(arm), seed, one, range);
    EXPECT_GT(range.second, 1.5 * range.first) << "the links of this arm have no effect";
    std::printf("%d: %.3g to %.3g kg, worst %.3g, %d of %d, explained %.5f, better %.3g\n",
                static_cast<int>(seed), range.first, range.second, one.worst, one.held, one.all,
                found->explained, found->better);
    score.worst = std::max(score.worst, one.worst);
    score.held += one.held;
    score.all += one.all;
    // The mass measured at each place agrees with the constants.
    EXPECT_EQ(found->places.size(), 7U);
    for (const LinkFit::Place& place : found->places) {
      for (const Estimate& seen : place.seen) {
        EXPECT_NEAR(seen.value, 1, 0.05);
        held_places += seen.holds(1) ? 1 : 0;
        ++all_places;
      }
    }
  }
  std::printf("worst %.3g; %d of %d intervals, %d of %d at the places\n", score.worst, score.held,
              score.all, held_places, all_places);
  EXPECT_LT(score.worst, score.max);
  EXPECT_GE(score.held, (long_form() ? 0.93 : 0.85) * score.all);
  EXPECT_GE(held_places, 0.85 * all_places);
}

TEST(IdentifyPlaces, ReportsOneMassForAnArmWithoutLinks) {
  for (std::uint64_t seed = 7100; seed < (long_form() ? 7120u : 7101u); ++seed) {
    SCOPED_TRACE(seed);
    const HiddenArm arm = hidden_arm(seed);
    const auto found = fitted(arm, seed, long_form() ? 5 : 2, long_form() ? 7 : 5);
    ASSERT_TRUE(found.ok()) << found.error().message;
    EXPECT_FALSE(found->links) << found->better;
    EXPECT_EQ(found->theta.segment<6>(LinkFit::kInertia), (Eigen::Matrix<double, 6, 1>::Zero()));
    EXPECT_LT(found->max_change, 0.15);
    const double mass = arm.file.simulated.plant.mass / mean_of_gains(arm);
    std::printf("%d: mass off by %.3g, change below %.2g, better %.3g\n", static_cast<int>(seed),
                found->theta[LinkFit::kMass] / mass - 1, found->max_change, found->better);
    EXPECT_NEAR(found->theta[LinkFit::kMass], mass, 0.005 * mass);
  }
}

TEST(IdentifyPlaces, FitWithALowerForceLimit) {
  const HiddenArm arm = linked_arm(7002);
  const auto found = fitted(arm, 1, 2, 5, 0.5);
  EXPECT_TRUE(found.ok()) << found.error().message;
}

TEST(IdentifyPlaces, AreSkippedIfLinksCannotBeDetected) {
  const auto said = [](const char* name, int places, bool stretches, bool held) {
    const scene::ArmFile file = scene::load_arm(name).value();
    auto bench = simulated_bench(file, 0);
    EXPECT_TRUE(bench.ok());
    const std::atomic<bool> never{false};
    const auto over =
        sweep_workspace(**bench, file, {.seconds = 2}, places, {}, {}, stretches, held, never);
    if (!over || over->fit) return std::string("it went: ") + name;
    EXPECT_EQ((*bench)->true_force_max(), 0);
    return over->not_done;
  };
  EXPECT_EQ(said("vintage_phantom", 0, false, false), "not requested.");
  EXPECT_NE(said("falcon", 7, false, false).find("other geometries"), std::string::npos);
  EXPECT_NE(said("vintage_phantom", 7, true, false).find("cables"), std::string::npos);
  EXPECT_NE(said("vintage_phantom", 7, false, true).find("holds the tip"), std::string::npos);
}

TEST(IdentifyPlaces, StopEndsWithZeroForce) {
  const HiddenArm arm = hidden_arm(3);
  auto bench = simulated_bench(arm.file, 0);
  ASSERT_TRUE(bench.ok());
  std::atomic<bool> stop{false};
  int ticks = 0;
  (*bench)->watch([&](const driver::TickRecord&) { stop = ++ticks > 3000; });
  const auto motions =
      record_at_points(**bench, arm.file, {.seconds = 2}, sweep_points(arm.file, 3), stop);
  ASSERT_FALSE(motions.ok());
  EXPECT_NE(motions.error().message.find("Stopped"), std::string::npos);
  EXPECT_LT(ticks, 3010);
  EXPECT_TRUE((*bench)->device().zero_assured());
}

}  // namespace
}  // namespace thimble::bringup
