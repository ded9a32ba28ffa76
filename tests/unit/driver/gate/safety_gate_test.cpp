#include "thimble/driver/safety_gate.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "support/open_gate.h"
#include "support/random.h"
#include "support/vintage_arm.h"

namespace thimble::driver {
namespace {

constexpr double kPeriod = 1e-3;
const Eigen::Vector3d kStill{0, 0, 0};

GateLimits limits() {
  return support::vintage_settings().limits;
}

using support::open_gate;

TEST(SafetyGate, ForceWithinAllLimitsIsUnchanged) {
  SafetyGate gate = open_gate();
  const Eigen::Vector3d f{0.5, -1, 0.3};
  EXPECT_EQ(gate.pass(f, kStill, kPeriod).f_T_W(), f);
  EXPECT_EQ(gate.counters().limited + gate.counters().rise_limited, 0u);
}

TEST(SafetyGate, NeverExceedsTheLimitAndKeepsTheDirection) {
  support::Random random(41);
  GateLimits swift = limits();
  swift.rise_max = 1e5;  // 100 N per tick: allows any change in this test
  SafetyGate gate = open_gate(swift);
  for (int i = 0; i < 10'000; ++i) {
    const Eigen::Vector3d f = random.in_box(20);
    const Eigen::Vector3d sent = gate.pass(f, kStill, kPeriod).f_T_W();
    EXPECT_LE(sent.norm(), limits().force_max * (1 + 1e-15));
    EXPECT_LT((sent.normalized() - f.normalized()).norm(), 1e-12);
  }
  EXPECT_GT(gate.counters().limited, 1000u);
}

TEST(SafetyGate, LimitsOnlyTheRiseOfAForce) {
  GateLimits slow = limits();
  slow.rise_max = 100;
  SafetyGate gate = open_gate(slow);
  for (int k = 1; k <= 30; ++k) {
    EXPECT_NEAR(gate.pass({0, 0, 3}, kStill, kPeriod).f_T_W().z(), std::min(3.0, 0.1 * k), 1e-12);
  }
  // A falling force is followed at once: slowing it would give energy back to the hand [PHYSICS
  // 1.6].
  EXPECT_EQ(gate.pass({0, 0, 0.2}, kStill, kPeriod).f_T_W().z(), 0.2);
  EXPECT_EQ(gate.pass({0, 0, 0}, kStill, kPeriod).f_T_W().z(), 0);
}

/// Moves into a wall and out on the same path; returns the work done on the hand, J.
double work_of_visit(double rise_max, double stiffness, double speed) {
  GateLimits with = limits();
  with.rise_max = rise_max;
  SafetyGate gate = open_gate(with);
  constexpr double kTick = 1e-5;
  double work = 0, x = 0;
  const int half = static_cast<int>(0.004 / speed / kTick);
  for (int k = 0; k < 2 * half; ++k) {
    const double v = k < half ? speed : -speed;
    // Midpoint of the tick, so that an elastic wall does no net work without a gate.
    const double f = -stiffness * (x + v * kTick / 2);
    work += gate.pass({f, 0, 0}, {v, 0, 0}, kTick).f_T_W().x() * v * kTick;
    x += v * kTick;
  }
  return work;
}

TEST(SafetyGate, FastRiseLimitKeepsAWallPassive) {
  for (const double speed : {0.1, 0.3, 1.0, 2.0}) {
    EXPECT_LE(work_of_visit(1000 * speed * 1.01, 1000, speed), 1e-9) << speed;
  }
}

TEST(SafetyGate, MakesAWallActiveWhenItsRiseLimitIsTooLow) {
  // Shows that the test above can fail: even a limit on the rise only returns more energy on the
  // way out than it took on the way in, if it is below stiffness times speed. Hence the default of
  // the arms.
  for (const double speed : {0.3, 1.0, 2.0}) {
    EXPECT_GT(work_of_visit(1000 * speed * 0.3, 1000, speed), 1e-4) << speed;
  }
  EXPECT_GE(limits().rise_max, 1000 * 2.0);
}

TEST(SafetyGate, OpensSlowlyAfterARestart) {
  SafetyGate gate(limits());
  double worst = 0;
  for (int k = 0; k < 300; ++k) {
    const double force = gate.pass({0, 0, 100}, kStill, k == 0 ? 0 : kPeriod).f_T_W().norm();
    worst = std::max(worst, force - limits().force_max * k * kPeriod / limits().soft_start);
  }
  EXPECT_LT(worst, 1e-12);
  EXPECT_GT(gate.counters().soft_started, 290u);
}

TEST(SafetyGate, LatchesZeroForceOnAForceThatIsNotANumber) {
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL, std::numeric_limits<double>::max()}) {
    SafetyGate gate = open_gate();
    EXPECT_EQ(gate.pass({0, bad, 0}, kStill, kPeriod).f_T_W(), Eigen::Vector3d(0, 0, 0)) << bad;
    EXPECT_EQ(gate.fault(), Fault::kForceNotFinite);
    EXPECT_EQ(gate.pass({0, 1, 0}, kStill, kPeriod).f_T_W(), Eigen::Vector3d(0, 0, 0));
    gate.restart();
    EXPECT_EQ(gate.fault(), Fault::kNone);
  }
}

TEST(SafetyGate, LatchesZeroForceOnRunawaySpeed) {
  SafetyGate gate = open_gate();
  EXPECT_GT(gate.pass({1, 0, 0}, {2.99, 0, 0}, kPeriod).f_T_W().norm(), 0);
  EXPECT_EQ(gate.pass({1, 0, 0}, {3.01, 0, 0}, kPeriod).f_T_W().norm(), 0);
  EXPECT_EQ(gate.fault(), Fault::kOverSpeed);
  SafetyGate other = open_gate();
  EXPECT_EQ(other.pass({1, 0, 0}, {NAN, 0, 0}, kPeriod).f_T_W().norm(), 0);
  EXPECT_EQ(other.fault(), Fault::kStateNotFinite);
}

TEST(SafetyGate, StallReopensAndWatchdogFaults) {
  SafetyGate gate = open_gate();
  EXPECT_GT(gate.pass({1, 0, 0}, kStill, kPeriod).f_T_W().norm(), 0.9);
  EXPECT_EQ(gate.pass({1, 0, 0}, kStill, 0.030).f_T_W().norm(), 0);
  EXPECT_EQ(gate.counters().stalls, 1u);
  EXPECT_EQ(gate.fault(), Fault::kNone);
  // With the limit opening at force_max / reopen, 1 N is back after 8 ms.
  for (int k = 0; k < 7; ++k) {
    EXPECT_LT(gate.pass({1, 0, 0}, kStill, kPeriod).f_T_W().norm(), 0.9);
  }
  EXPECT_NEAR(gate.pass({1, 0, 0}, kStill, kPeriod).f_T_W().norm(), 1, 1e-9);

  EXPECT_EQ(gate.pass({1, 0, 0}, kStill, 0.100).f_T_W().norm(), 0);
  EXPECT_EQ(gate.fault(), Fault::kLoopStalled);
}

TEST(SafetyGate, StallDoesNotShortenTheSoftStart) {
  SafetyGate gate(limits());
  for (int k = 0; k < 100; ++k) gate.pass({5, 0, 0}, kStill, kPeriod);
  gate.pass({5, 0, 0}, kStill, 0.030);
  for (int k = 0; k < 60; ++k) gate.pass({5, 0, 0}, kStill, kPeriod);
  EXPECT_NEAR(gate.pass({5, 0, 0}, kStill, kPeriod).f_T_W().norm(), 61e-3 * 5 / 0.3, 1e-9);
}

EnergyGuardSettings passivity() {
  return {.stage = EnergyStage::kPassivity, .mass = 0.075, .allowance = 0, .reservoir = 0.02};
}

/// Makes a gate with an energy stage whose soft start is over and whose account is empty.
SafetyGate open_guarded_gate(const EnergyGuardSettings& settings) {
  SafetyGate gate(limits(), settings);
  for (int k = 0; k < 400; ++k) gate.pass_guarded({0, 0, 0}, kStill, kPeriod, {});
  return gate;
}

TEST(EnergyGuard, ForceIsUnchangedWhileTheHandHasPaid) {
  SafetyGate gate = open_guarded_gate(passivity());
  const Eigen::Vector3d f{0.5, -1, 0.3};
  // The hand gives 1 mJ and gets a part of it back.
  EXPECT_EQ(gate.pass_guarded(f, {0.1, 0, 0}, kPeriod, {.work = -1e-3}).f_T_W(), f);
  EXPECT_EQ(gate.pass_guarded(f, {0.1, 0, 0}, kPeriod, {.work = 0.9e-3}).f_T_W(), f);
  EXPECT_EQ(gate.counters().damped, 0u);
  EXPECT_NEAR(gate.energy(), 0.1e-3, 1e-15);
}

TEST(EnergyGuard, DampsExactlyTheDebt) {
  SafetyGate gate = open_guarded_gate(passivity());
  const Eigen::Vector3d v{0.1, -0.2, 0.1};
  const Eigen::Vector3d f = gate.pass_guarded({0, 0, 0}, v, kPeriod, {.work = 1e-4}).f_T_W();
  EXPECT_NEAR(-f.dot(v) * kPeriod, 1e-4, 1e-12);
  EXPECT_LT(f.cross(v).norm(), 1e-12);
  // For any debt, the damping is at most mass / period, the force is at most the limit, and it
  // rises no faster than the rise limit.
  const Eigen::Vector3d slow{0.001, 0, 0};
  EXPECT_NEAR(gate.pass_guarded({0, 0, 0}, slow, kPeriod, {.work = 1}).f_T_W().x(), -0.075, 1e-12);
  for (const double expected : {-2.075, -4.075, -5.0}) {
    EXPECT_NEAR(gate.pass_guarded({0, 0, 0}, {1, 0, 0}, kPeriod, {}).f_T_W().x(), expected, 1e-12);
  }
  EXPECT_EQ(gate.counters().damped, 5u);
  EXPECT_LT(gate.counters().min_energy, -0.9);
}

TEST(EnergyGuard, CreditIsBoundedByTheReservoir) {
  EnergyGuardSettings settings = passivity();
  settings.allowance = 0.002;
  SafetyGate gate(limits(), settings);
  for (int k = 0; k < 400; ++k) gate.pass_guarded({0, 0, 0}, kStill, kPeriod, {.work = -1});
  EXPECT_EQ(gate.energy(), 0.02);
  const auto damped = [&](double work) {
    return gate.pass_guarded({0, 0, 0}, {0.1, 0, 0}, kPeriod, {.work = work}).f_T_W().norm() > 0;
  };
  EXPECT_FALSE(damped(0.0219));
  EXPECT_TRUE(damped(0.0002));
}

/// A gate that fades forces from a debt of 2 mJ beyond its allowance; its soft start is over.
SafetyGate open_gate_with_onset() {
  EnergyGuardSettings settings = passivity();
  settings.onset = 0.002;
  return open_guarded_gate(settings);
}

/// Returns the force (N) that passes of 2 N, after the arm did `work` (J) on the hand.
double sent_at_rest(SafetyGate& gate, double work) {
  return gate.pass_guarded({2, 0, 0}, kStill, kPeriod, {.work = work}).f_T_W().x();
}

TEST(EnergyGuard, FadesTheForceOfADebtBeyondItsOnsetEvenAtRest) {
  SafetyGate gate = open_gate_with_onset();
  const auto sent = [&](double work) { return sent_at_rest(gate, work); };
  EXPECT_EQ(sent(0.002), 2);           // at the onset
  EXPECT_NEAR(sent(0.001), 1, 1e-9);   // half-way beyond
  EXPECT_NEAR(sent(0.002), 0, 1e-12);  // zero at twice the onset
}

TEST(EnergyGuard, FadedForceReturnsSlowly) {
  SafetyGate gate = open_gate_with_onset();
  const auto sent = [&](double work) { return sent_at_rest(gate, work); };
  EXPECT_NEAR(sent(0.003), 1, 1e-9);
  // A force that returned with its debt would act as a spring of stiffness F^2 / onset.
  EXPECT_NEAR(sent(-0.0019), 1, 1e-9);
  EXPECT_NEAR(sent(-0.0002), 1, 2e-3);
  double last = sent(0), most = 0;
  for (int k = 0; k < 1000; ++k) {
    const double now = sent(0);
    most = std::max(most, now - last);
    last = now;
  }
  EXPECT_NEAR(most, 2 * kPeriod / PassivityObserver::kReturn, 1e-9);
  EXPECT_NEAR(last, 2, 2e-3);
}

TEST(EnergyGuard, ForceReturnsAfterADebt) {
  // The settings of the program: some energy is allowed, and one count is not damped.
  for (const double debt : {0.0045, 0.0055, 0.006, 0.012, 0.1}) {
    EnergyGuardSettings settings = passivity();
    settings.allowance = settings.onset = 0.002;
    settings.speed_floor = 0.014;
    SafetyGate gate = open_guarded_gate(settings);
    sent_at_rest(gate, debt);
    // Now the hand presses 4 mm into 1 N/mm, once a second; the work is the sent force times the
    // displacement.
    double f = 0, x = 0, most = 0;
    for (int k = 0; k < 20000; ++k) {
      const double to = -0.004 * std::sin(2 * std::numbers::pi * k * kPeriod);
      const double wanted = std::max(0.0, -1000 * to);
      const EnergyFlow flow{.work = f * (to - x), .held = 0.5 * wanted * std::max(0.0, -to)};
      f = gate.pass_guarded({wanted, 0, 0}, {(to - x) / kPeriod, 0, 0}, kPeriod, flow).f_T_W().x();
      x = to;
      if (k >= 15000) most = std::max(most, f);
    }
    EXPECT_NEAR(most, 4, 0.05) << debt;
    EXPECT_EQ(gate.fault(), Fault::kNone);
  }
}

TEST(EnergyGuard, DoesNotDampSpeedsBelowOneCount) {
  EnergyGuardSettings settings = passivity();
  settings.speed_floor = 0.02;
  SafetyGate gate = open_guarded_gate(settings);
  const auto damped = [&](double v) {
    return gate.pass_guarded({0, 0, 0}, {v, 0, 0}, kPeriod, {.work = 1}).f_T_W().x();
  };
  EXPECT_EQ(damped(0.0199), 0);
  EXPECT_NEAR(damped(0.021), -75 * 0.001, 1e-9);  // above it, without a jump
  EXPECT_NEAR(damped(-0.04), 75 * 0.02, 1e-9);
}

TEST(EnergyGuard, CreditLastsWhileSpringsArePressed) {
  SafetyGate gate = open_guarded_gate(passivity());
  gate.pass_guarded({0, 0, 0}, kStill, kPeriod, {.work = -0.09, .held = 0.08});
  EXPECT_NEAR(gate.energy(), 0.09, 1e-12);
  // Stored energy gives no credit for work that the hand did not do.
  gate.pass_guarded({0, 0, 0}, kStill, kPeriod, {.work = 0.05, .held = 0.5});
  EXPECT_NEAR(gate.energy(), 0.04, 1e-12);
  // A hand that presses with its whole weight keeps its credit.
  gate.pass_guarded({0, 0, 0}, kStill, kPeriod, {.work = -1, .held = 3});
  EXPECT_NEAR(gate.energy(), 1.04, 1e-12);
  for (const double held : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    gate.pass_guarded({0, 0, 0}, kStill, kPeriod, {.held = held});
    EXPECT_LE(gate.energy(), 0.02) << held;
  }
}

TEST(EnergyGuard, SoftStartAlsoLimitsDamping) {
  SafetyGate gate(limits(), passivity());
  gate.pass_guarded({0, 0, 0}, kStill, 0, {});
  EXPECT_NEAR(gate.pass_guarded({0, 0, 0}, {1, 0, 0}, kPeriod, {.work = 1}).f_T_W().norm(),
              5e-3 / 0.3, 1e-12);
}

TEST(EnergyGuard, BoundingStageLimitsForceByItsSlope) {
  SafetyGate gate = open_guarded_gate({.stage = EnergyStage::kBounding, .slope = 10});
  // From zero force, 1 mm of motion allows 10 mN; at 2 N, 1 mm back costs at least 10 mN.
  EXPECT_NEAR(gate.pass_guarded({3, 0, 0}, kStill, kPeriod, {.move_W = {-1e-3, 0, 0}}).f_T_W().x(),
              0.01, 1e-15);
  const EnergyFlow back{.move_W = {1e-3, 0, 0}, .f_sent_W = {2, 0, 0}};
  EXPECT_NEAR(gate.pass_guarded({2, 0, 0}, kStill, kPeriod, back).f_T_W().x(), 1.99, 1e-15);
  EXPECT_EQ(gate.pass_guarded({1, 0, 0}, kStill, kPeriod, back).f_T_W().x(), 1);
  EXPECT_EQ(gate.counters().bounded, 2u);
}

TEST(EnergyGuard, ZeroForceForEnergyThatIsNotFinite) {
  for (const EnergyGuardSettings& settings :
       {passivity(), EnergyGuardSettings{.stage = EnergyStage::kBounding, .slope = 10}}) {
    SafetyGate gate = open_guarded_gate(settings);
    const EnergyFlow bad{.work = NAN, .move_W = {NAN, 0, 0}};
    EXPECT_EQ(gate.pass_guarded({1, 0, 0}, {1, 0, 0}, kPeriod, bad).f_T_W().norm(), 0);
    EXPECT_EQ(gate.fault(), Fault::kStateNotFinite);
  }
}

TEST(SafetyGate, KeepsTheFirstFault) {
  SafetyGate gate(limits());
  gate.trip(Fault::kTransportLost);
  gate.trip(Fault::kOverSpeed);
  EXPECT_EQ(gate.fault(), Fault::kTransportLost);
}

TEST(Fault, DescriptionHasARemedy) {
  for (int i = 0; i <= static_cast<int>(kLastFault); ++i) {
    const auto fault = static_cast<Fault>(i);
    EXPECT_NE(name(fault), "unknown");
    EXPECT_EQ(describe(fault).back(), '.');
  }
}

TEST(EnergyGuard, RestartClearsDebtAndFading) {
  PassivityObserver observer(
      {.stage = EnergyStage::kPassivity, .mass = 0.075, .reservoir = 0.02, .onset = 0.01});
  observer.book(1);
  EXPECT_EQ(observer.energy(), -1);
  EXPECT_EQ(observer.share(kPeriod), 0);
  observer.restart();
  EXPECT_EQ(observer.energy(), 0);
  EXPECT_EQ(observer.share(kPeriod), 1);
}

}  // namespace
}  // namespace thimble::driver
