#include "gate/program_watch.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "support/explained_rig.h"

namespace thimble::driver {
namespace {

using support::explained_limits;
using support::explained_stage;
using support::ExplainedRig;

constexpr double kPeriodOfRig = ExplainedRig::kTick;

/// An arm that a hand moves into the wall of a program, along one axis.
struct Press {
  double damping = 3;      // N s/m, of arm and hand
  double share = 2;        // of the largest stable stiffness, damping / latency
  double speed = 0.1;      // m/s, of the hand
  double press = 1;        // N, at the end
  bool two_sided = false;  // a spring that acts on both sides of the wall
};

/// Result of a run.
struct Pressed {
  double wall = 0;     // N/m
  double found = -1;   // s from contact until the first oscillation was found; -1: none
  double swing = 0;    // amplitude of the tip in the last 0.2 s, m
  double lowered = 0;  // N, reduction of forces within the limit
};

constexpr double kTipMass = 0.1, kGripStiffness = 300;  // kg, N/m

Pressed press_on(const Press& press) {
  ExplainedRig rig(explained_limits(), explained_stage());
  Pressed result;
  result.wall = press.share * press.damping / (1.5 * kPeriodOfRig);
  const double deep = press.press * (1 / kGripStiffness + 1 / result.wall);
  double x = 3e-3, v = 0, touched = -1;
  rig.open({x, 0, 0});
  std::vector<double> window;
  for (int k = 0; k < 3000; ++k) {
    const double time = k * kPeriodOfRig;
    const double x_hand = std::max(3e-3 - press.speed * time, -deep);
    const double v_hand = x_hand > -deep ? -press.speed : 0;
    const double seen = 3e-5 * std::round(x / 3e-5);
    const double f = press.two_sided || seen < 0 ? -result.wall * seen : 0;
    ForceCommand command;
    command.f_T_W = command.f_program_W = {f, 0, 0};
    const double sent = rig.tick({seen, 0, 0}, command).x();
    if (std::abs(f) <= 5) result.lowered = std::max(result.lowered, std::abs(f - sent));
    if (x < 0 && touched < 0) touched = time;
    if (result.found < 0 && rig.gate().counters().oscillations > 0) result.found = time - touched;
    for (int i = 0; i < 20; ++i) {
      const double hand = -kGripStiffness * (x - x_hand) - press.damping * (v - v_hand);
      v += kPeriodOfRig / 20 * (rig.felt_W().x() + hand) / kTipMass;
      x += kPeriodOfRig / 20 * v;
    }
    if (k >= 2800) window.push_back(x);
  }
  const auto [low, high] = std::minmax_element(window.begin(), window.end());
  result.swing = *high - *low;
  return result;
}

std::string words(const Press& press) {
  return "b " + std::to_string(press.damping) + ", " + std::to_string(press.share) + " K_max, at " +
         std::to_string(press.speed) + " m/s with " + std::to_string(press.press) +
         (press.two_sided ? " N, spring" : " N, wall");
}

TEST(ProgramWatch, StopsAWallOfTwiceTheStiffnessInTime) {
  for (const double damping : {0.6, 1.0, 2.0, 3.0, 5.0}) {
    for (const double speed : {0.02, 0.1, 0.3}) {
      for (const double force : {0.5, 1.0, 2.0}) {
        for (const bool two_sided : {false, true}) {
          const Press press{damping, 2, speed, force, two_sided};
          const Pressed run = press_on(press);
          EXPECT_GE(run.found, 0) << words(press);
          // With little damping by the hand, an oscillation grows by a factor of e in 0.3 s.
          EXPECT_LT(run.found, damping < 1 ? 1.5 : 0.9) << words(press);
          EXPECT_LT(run.swing, damping < 1 ? 4e-3 : 5e-4) << words(press);
        }
      }
    }
  }
}

TEST(ProgramWatch, StopsAPinchGripsOscillationIn300Milliseconds) {
  // A pinch grip of 3 N s/m that presses firmly; the time is from contact.
  for (const double force : {1.0, 1.5, 2.0, 2.5}) {
    for (const double speed : {0.05, 0.1, 0.15}) {
      for (const bool two_sided : {false, true}) {
        const Press press{3, 2, speed, force, two_sided};
        const Pressed run = press_on(press);
        EXPECT_GE(run.found, 0) << words(press);
        EXPECT_LT(run.found, 0.3) << words(press);
        EXPECT_LT(run.swing, 1e-4) << words(press);
      }
    }
  }
}

TEST(ProgramWatch, IgnoresStableWalls) {
  for (const double damping : {0.6, 1.0, 2.0, 3.0, 5.0}) {
    for (const double share : {0.1, 0.3, 0.5, 0.7}) {
      for (const double speed : {0.02, 0.1, 0.3, 0.6}) {
        for (const double force : {0.3, 1.0, 2.5}) {
          for (const bool two_sided : {false, true}) {
            const Press press{damping, share, speed, force, two_sided};
            const Pressed run = press_on(press);
            EXPECT_LT(run.found, 0) << words(press);
            EXPECT_EQ(run.lowered, 0) << words(press);
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace thimble::driver
