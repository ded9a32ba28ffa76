// The exact law of a wall compared with the simulator, with different periods of loop, reports and
// wire.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "stability/tuning.h"
#include "stability/wall_bench.h"
#include "support/long_form.h"
#include "thimble/scene/scene_file.h"

namespace thimble {
namespace {

struct Pace {
  double rate = 1000;            // rate of the loop, Hz
  std::int64_t report_ns = 0;    // period of the arm's reports
  std::int64_t delay_in_ns = 0;  // delay of a report
  std::int64_t delay_out_ns = 0;
  double damping = 0;  // damping of the wall, N s/m
};

/// Returns a PHANTOM without dry friction, encoder steps and tremor, with these periods.
scene::ArmFile arm_at(const Pace& pace) {
  scene::ArmFile arm =
      scene::load_arm(std::string(THIMBLE_SOURCE_DIR) + "/app/arms/vintage_phantom.yaml").value();
  arm.simulated.plant.coulomb = 0;
  arm.simulated.hand.tremor_amplitude = 0;
  arm.simulated.firmware.ideal_encoders = true;
  arm.simulated.firmware.report_period_ns = pace.report_ns;
  arm.simulated.wire = {.delay_in_ns = pace.delay_in_ns, .delay_out_ns = pace.delay_out_ns};
  arm.velocity_corner_frequency = 0;
  return arm;
}

/// Returns whether the tip's oscillation on a two-sided spring grows in the simulator.
bool grows(const scene::ArmFile& arm, const Pace& pace, double stiffness) {
  constexpr double kDuration = 1.6, kEarly = 0.3, kWindow = 0.4;  // s
  stability::WallCase wall{
      .direction = stability::direction_at_home(arm, Eigen::Vector3d::UnitX()).value(),
      .tip = arm.simulated.plant,
      .hand = arm.simulated.hand,
      .stiffness = stiffness,
      .damping = pace.damping,
      .period_ns = std::llround(1e9 / pace.rate),
      .own_wire = true,
      .gaps_ns = {},
      .pull = 0.05,
      .pull_start = 0.1,
      .duration = kDuration,
      .give_up = 0.02};
  const auto run = stability::run_wall(arm, wall).value();
  if (run.gave_up) return true;
  const auto swing = [&run](double from) {
    double low = 1e9, high = -1e9;
    for (std::size_t i = 0; i < run.x.size(); ++i) {
      if (run.time[i] < from || run.time[i] >= from + kWindow) continue;
      low = std::min(low, run.x[i]);
      high = std::max(high, run.x[i]);
    }
    return high - low;
  };
  // An oscillation that has died out shows only the resolution of the encoders.
  const double late = swing(kDuration - kWindow);
  return late > 1e-8 && late > swing(kEarly);
}

/// Expects that the simulator's edge is within 5 % of the exact law.
void expect_edge(const Pace& pace) {
  const scene::ArmFile arm = arm_at(pace);
  const double law =
      stability::stability_limits(arm, stability::loop_times(arm, pace.rate), 1000, pace.damping)
          .stiffness_exact;
  const std::string cell =
      std::to_string(pace.rate) + " Hz, reports " + std::to_string(pace.report_ns) + " ns, wire " +
      std::to_string(pace.delay_in_ns) + " + " + std::to_string(pace.delay_out_ns) +
      " ns, damping " + std::to_string(pace.damping) + ": " + std::to_string(law) + " N/m";
  EXPECT_GT(law, 10) << cell;
  EXPECT_FALSE(grows(arm, pace, 0.95 * law)) << cell;
  EXPECT_TRUE(grows(arm, pace, 1.05 * law)) << cell;
}

TEST(ReportPace, LawIsTheSimulatedEdgeAtAnyPace) {
  const bool whole = support::long_form();
  const std::vector<double> rates =
      whole ? std::vector<double>{100, 200, 500, 700, 1000, 1500, 2000, 3000, 5000, 10'000, 20'000}
            : std::vector<double>{200, 700, 1000, 3000, 10'000};
  const std::vector<std::int64_t> reports =
      whole ? std::vector<std::int64_t>{50'000,    125'000,   250'000,   500'000,   1'000'000,
                                        2'000'000, 3'000'000, 5'000'000, 10'000'000}
            : std::vector<std::int64_t>{250'000, 1'000'000, 5'000'000};
  struct Delay {
    std::int64_t in, out;
  };
  const std::vector<Delay> delays =
      whole ? std::vector<Delay>{{0, 0},         {0, 1'000'000},       {300'000, 0},
                                 {1'000'000, 0}, {700'000, 1'200'000}, {0, 4'000'000}}
            : std::vector<Delay>{{0, 0}, {0, 1'000'000}, {700'000, 400'000}};
  for (const double rate : rates) {
    for (const std::int64_t report : reports) {
      for (const Delay& delay : delays) {
        expect_edge({rate, report, delay.in, delay.out, 0});
      }
    }
  }
}

TEST(ReportPace, LawHoldsForWallsWithDamping) {
  for (const Pace& pace : std::vector<Pace>{{10'000, 1'000'000, 0, 0, 3},
                                            {1000, 2'000'000, 0, 1'000'000, 3},
                                            {2000, 1'000'000, 300'000, 0, 3},
                                            {500, 1'000'000, 0, 1'000'000, 3}}) {
    expect_edge(pace);
  }
}

TEST(ReportPace, FasterLoopGainsNothingBeyondTheReports) {
  const scene::ArmFile arm = arm_at({.report_ns = 1'000'000, .delay_out_ns = 1'000'000});
  const auto edge = [&arm](double rate) {
    return stability::stability_limits(arm, stability::loop_times(arm, rate), 1000, 0)
        .stiffness_exact;
  };
  EXPECT_NEAR(edge(10'000) / edge(1000), 1, 1e-6);
}

}  // namespace
}  // namespace thimble
