// The gate uses the time of a tick: the rise limit and the soft start depend on it. An invalid time
// must switch the force off; it must not disable a limit.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/open_gate.h"
#include "support/vintage_arm.h"
#include "thimble/driver/safety_gate.h"

namespace thimble::driver::gate_time_test {
namespace {

constexpr double kPeriod = 1e-3;
const Eigen::Vector3d kStill{0, 0, 0};

TEST(GateTime, LatchesZeroForceOnAnInvalidTime) {
  for (const double bad : {-1.0, -1e-2, -1e-9, -5e-324, std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    SafetyGate gate = support::open_gate();
    EXPECT_EQ(gate.pass({4, 0, 0}, kStill, bad).f_T_W(), Eigen::Vector3d(0, 0, 0)) << bad;
    EXPECT_EQ(gate.fault(), Fault::kTimeNotMonotonic) << bad;
    EXPECT_EQ(gate.pass({4, 0, 0}, kStill, kPeriod).f_T_W(), Eigen::Vector3d(0, 0, 0)) << bad;
    gate.restart();
    EXPECT_EQ(gate.fault(), Fault::kNone);
  }
}

TEST(GateTime, LatchesZeroForceWithAnEnergyStageToo) {
  for (const EnergyStage stage : {EnergyStage::kPassivity, EnergyStage::kBounding}) {
    for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) {
      SafetyGate gate(support::vintage_settings().limits,
                      {.stage = stage, .mass = 0.075, .reservoir = 0.02, .onset = 1, .slope = 10});
      for (int k = 0; k < 400; ++k) gate.pass_guarded({0, 0, 0}, kStill, kPeriod, {});
      EXPECT_EQ(gate.pass_guarded({1, 0, 0}, {0.1, 0, 0}, bad, {.work = 1e-3}).f_T_W(),
                Eigen::Vector3d(0, 0, 0));
      EXPECT_EQ(gate.fault(), Fault::kTimeNotMonotonic) << bad;
    }
  }
}

TEST(GateTime, ForceDoesNotRiseInATickOfZeroLength) {
  SafetyGate gate = support::open_gate();
  EXPECT_EQ(gate.pass({1, 0, 0}, kStill, kPeriod).f_T_W().x(), 1);
  EXPECT_EQ(gate.pass({2, 0, 0}, kStill, 0).f_T_W().x(), 1);
  EXPECT_EQ(gate.pass({0.5, 0, 0}, kStill, 0).f_T_W().x(), 0.5);
  EXPECT_EQ(gate.fault(), Fault::kNone);
}

TEST(GateTime, JumpForwardIsAStallOrWatchdogFault) {
  SafetyGate gate = support::open_gate();
  gate.pass({1, 0, 0}, kStill, 0.03);
  EXPECT_EQ(gate.counters().stalls, 1U);
  EXPECT_EQ(gate.fault(), Fault::kNone);
  gate.pass({1, 0, 0}, kStill, 1e6);
  EXPECT_EQ(gate.fault(), Fault::kLoopStalled);
}

}  // namespace
}  // namespace thimble::driver::gate_time_test
