// Amplifiers that lag and cables that stretch: the simulated arm compared with the linear loop of
// both masses and with the law [PHYSICS 1.1].
#include "studies/stability/drive_train_walls.h"

#include <gtest/gtest.h>

#include "studies/stability/study_stability.h"

namespace thimble::twin {
namespace {

TEST(DriveTrainWalls, MatchTheLinearLoopAndTheLaw) {
  const auto setup = studies::stability_setup({.arm_file = "vintage_phantom", .direction = {}});
  ASSERT_TRUE(setup.ok()) << setup.error().message;
  using enum studies::StabilityPart;
  // A lag; a cable with high friction of the tip; a cable with a motor that only its damping holds;
  // a nearly stiff cable.
  for (const studies::StabilityCell& cell : {studies::StabilityCell{.part = kLagEdge, .a = 0.001},
                                             {.part = kCableEdge, .a = 6.8e3, .b = 3},
                                             {.part = kCableEdge, .a = 3.2e4, .b = 0.3},
                                             {.part = kCableEdge, .a = 3e5, .b = 1}}) {
    const stability::SampledWall linear = studies::drive_train_wall(*setup, cell);
    const double exact = stability::stiffness_edge(linear);
    const auto found = studies::drive_train_edge(*setup, cell);
    ASSERT_TRUE(found.ok()) << found.error().message;
    // Near the edge the motor's oscillation grows slowly while the tip's decays slowly.
    EXPECT_NEAR(*found / exact, 1, 0.04) << cell.a << " " << cell.b;
    EXPECT_NEAR(stability::limit_by_phase(linear) / exact, 1, 0.03) << cell.a << " " << cell.b;
  }
}

}  // namespace
}  // namespace thimble::twin
