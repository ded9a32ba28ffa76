// The stiffest wall on which a tip rests, if stiffer walls beyond an unstable range rest again.

#include "stability/raised_edge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "stability/tuning.h"
#include "stability/wall_trial.h"
#include "support/identify/hidden_arm.h"
#include "thimble/scene/arm_simulation.h"
#include "worst_direction.h"

namespace thimble::stability {
namespace {

TEST(RaisedEdge, IsBelowTheFirstWallThatDoesNotRest) {
  const auto rests = [](double stiffness) -> driver::Result<bool> {
    return stiffness < 850 || (stiffness > 990 && stiffness < 3000);
  };
  const auto edge = raised_edge(100, 10'000, rests);
  ASSERT_TRUE(edge);
  EXPECT_LT(*edge, 850);
  EXPECT_GT(*edge, 0.99 * 850);
}

TEST(RaisedEdge, ReachesMaxStiffnessIfAllRest) {
  const auto edge = raised_edge(100, 10'000, [](double) -> driver::Result<bool> { return true; });
  ASSERT_TRUE(edge);
  EXPECT_GE(*edge, 10'000);
  EXPECT_LE(*edge, 10'000 * kWallRaised * kWallRaised);
}

TEST(RaisedEdge, ReturnsErrorOfFailedTrial) {
  for (const double out_of_reach :
       {535.0, 1003.0}) {  // while the stiffness is raised, and during the bisection
    const auto edge = raised_edge(100, 10'000, [&](double stiffness) -> driver::Result<bool> {
      if (std::abs(stiffness - out_of_reach) < 0.02 * out_of_reach) return driver::Error{"too far"};
      return stiffness < 1000;
    });
    ASSERT_FALSE(edge);
    EXPECT_EQ(edge.error().message, "too far");
  }
}

// Bisection of the whole range returned an isolated stable wall among unstable ones, 1,654 N/m.
TEST(RaisedEdge, FewWallsBelowItOfSimulatedArmAreUnstable) {
  scene::ArmFile arm = support::hidden_arm(18).file;
  arm.simulated.hand.tremor_amplitude = 0;
  const StabilityLimits carried = stability_limits(arm, loop_times(arm, 1000), 1000, 0);
  const double quiet = kQuietAtRest + kQuietSteps * carried.tip.encoder_step;
  WallTrial trial{.p_W = scene::points_of_workspace(arm, 1).front(),
                  .n_W = Eigen::Vector3d::UnitY(),
                  .rate = 1000};
  const auto edge = simulated_edge(arm, trial, carried.stiffness_exact, quiet);
  ASSERT_TRUE(edge) << edge.error().message;
  int walls = 0, rests = 0;
  for (trial.stiffness = carried.stiffness_exact / 3; trial.stiffness < *edge;
       trial.stiffness *= 1.04) {
    const auto touch = press_on_wall(arm, trial);
    ASSERT_TRUE(touch) << touch.error().message;
    ++walls;
    rests += comes_to_rest(*touch, quiet);
  }
  std::printf("  %.0f N/m; below it %d of %d walls rest\n", *edge, rests, walls);
  EXPECT_GE(walls, 10);
  EXPECT_GE(rests, 0.75 * walls);
}

}  // namespace
}  // namespace thimble::stability
