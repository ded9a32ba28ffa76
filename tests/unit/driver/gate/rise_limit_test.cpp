// The rise limit applies to the vector that is added to the old force, in any direction, not only
// to the growth of its magnitude.

#include "thimble/driver/safety_gate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "support/open_gate.h"
#include "support/random.h"

namespace thimble::driver::rise_limit_test {
namespace {

using Eigen::Vector3d;

constexpr double kPeriod = 1e-3;
const Vector3d kStill{0, 0, 0};

GateLimits limits() {
  return support::vintage_settings().limits;  // 5 N, 2 N per tick
}

TEST(RiseLimit, ReversalTakesTheTimeOfItsRise) {
  SafetyGate gate = support::open_gate();
  while (gate.pass({5, 0, 0}, kStill, kPeriod).f_T_W().x() < 5) {
  }
  // A change of 10 N.
  for (const double expected : {3.0, 1.0, -1.0, -3.0, -5.0}) {
    EXPECT_NEAR(gate.pass({-5, 0, 0}, kStill, kPeriod).f_T_W().x(), expected, 1e-12);
  }
  EXPECT_EQ(gate.counters().rise_limited, 2U + 4U);  // two ticks on the way to 5 N
}

TEST(RiseLimit, TurnTakesTheTimeOfItsRise) {
  SafetyGate gate = support::open_gate();
  for (int k = 0; k < 3; ++k) gate.pass({5, 0, 0}, kStill, kPeriod);
  Vector3d last(5, 0, 0);
  int ticks = 0;
  while (last != Vector3d(0, 5, 0) && ticks < 100) {
    const Vector3d now = gate.pass({0, 5, 0}, kStill, kPeriod).f_T_W();
    EXPECT_LE((now - last).norm(), 2 + 1e-12);
    EXPECT_GE(now.norm(), 5 / std::sqrt(2.0) - 1e-12);  // the force does not drop meanwhile
    last = now;
    ++ticks;
  }
  EXPECT_EQ(ticks, 4);  // 7.07 N in steps of 2 N
}

TEST(RiseLimit, DropsAForceThatWouldPushTheHand) {
  // Friction of 5 N, and the hand has just reversed: the old force would push it.
  SafetyGate gate = support::open_gate();
  for (int k = 0; k < 3; ++k) gate.pass({5, 0, 0}, {-0.2, 0, 0}, kPeriod);
  for (const double expected : {-2.0, -4.0, -5.0}) {
    EXPECT_NEAR(gate.pass({-5, 0, 0}, {0.2, 0, 0}, kPeriod).f_T_W().x(), expected, 1e-12);
  }
}

TEST(RiseLimit, OneCountOfVelocityDropsNoForce) {
  const EnergyGuardSettings noise{.speed_floor = 0.014};
  for (const double speed : {0.0139, 0.0141}) {
    SafetyGate gate = support::open_gate(limits(), noise);
    for (int k = 0; k < 3; ++k) gate.pass({5, 0, 0}, kStill, kPeriod);
    EXPECT_NEAR(gate.pass({-5, 0, 0}, {speed, 0, 0}, kPeriod).f_T_W().x(), speed < 0.014 ? 3 : -2,
                1e-12);
  }
}

TEST(RiseLimit, AppliesToDampingToo) {
  // A debt that cannot be paid, at 1 m/s: 5 N of damping are requested at once.
  SafetyGate gate = support::open_gate(
      limits(), {.stage = EnergyStage::kPassivity, .mass = 0.075, .reservoir = 0.02});
  gate.pass_guarded({0, 0, 0}, kStill, kPeriod, {.work = 1});
  for (const double expected : {-2.0, -4.0, -5.0}) {
    EXPECT_NEAR(gate.pass_guarded({0, 0, 0}, {1, 0, 0}, kPeriod, {}).f_T_W().x(), expected, 1e-12);
  }
  // When the velocity reverses, the old damping is removed at once.
  EXPECT_NEAR(gate.pass_guarded({0, 0, 0}, {-1, 0, 0}, kPeriod, {}).f_T_W().x(), 2, 1e-12);
}

TEST(RiseLimit, RejectedForceDoesNotCount) {
  SafetyGate gate = support::open_gate();
  gate.pass({2, 0, 0}, kStill, kPeriod);
  gate.pass({4, 0, 0}, kStill, kPeriod);  // refused
  gate.resume_from({2, 0, 0});
  EXPECT_NEAR(gate.pass({5, 0, 0}, kStill, kPeriod).f_T_W().x(), 4, 1e-12);
  for (const double bad : {std::nan(""), HUGE_VAL}) {
    gate.resume_from({0, bad, 0});
    EXPECT_NEAR(gate.pass({5, 0, 0}, kStill, kPeriod).f_T_W().x(), 2, 1e-12);
  }
}

/// Returns the distance of a point from the segment between the origin and `end`.
double distance_from_segment(const Vector3d& point, const Vector3d& end) {
  const double square = end.squaredNorm();
  const double share = square > 0 ? std::clamp(point.dot(end) / square, 0.0, 1.0) : 0;
  return (point - share * end).norm();
}

/// Draws a requested force, often a difficult case.
Vector3d draw_wanted(support::Random& random, const Vector3d& last) {
  switch (random.bits() % 8) {
    case 0:
      return {0, 0, 0};
    case 1:
      return -last;
    case 2:
      return random.uniform(0, 1) * last;
    case 3:
      return random.uniform(1, 3) * last;
    case 4:
      return 1e-12 * random.in_box(1);
    case 5:
      return last + 1e-9 * random.in_box(1);
    default:
      return random.in_box(9);
  }
}

/// Draws the limits and the energy stage of one sequence.
GateLimits draw_limits(support::Random& random) {
  GateLimits drawn = limits();
  drawn.rise_max = std::pow(10, random.uniform(1, 5));
  drawn.force_max = random.uniform(0.5, 9);
  drawn.soft_start = random.uniform(1e-3, 0.05);
  return drawn;
}

EnergyGuardSettings draw_energy(support::Random& random) {
  EnergyGuardSettings drawn;
  drawn.stage = static_cast<EnergyStage>(random.bits() % 3);
  drawn.mass = 0.075;
  drawn.reservoir = 0.02;
  drawn.onset = random.bits() % 2 == 0 ? 0.002 : 0;
  drawn.speed_floor = random.bits() % 2 == 0 ? 0.014 : 0;
  drawn.slope = random.uniform(10, 1e4);
  return drawn;
}

TEST(RiseLimit, AddsAtMostItsRisePerTick) {
  support::Random random(16);
  std::uint64_t limited = 0, damped = 0;
  for (int sequence = 0; sequence < 100'000; ++sequence) {
    const GateLimits with = draw_limits(random);
    const EnergyGuardSettings energy = draw_energy(random);
    SafetyGate gate(with, energy);
    Vector3d last(0, 0, 0);
    double time = 0;
    for (int k = 0; k < 10; ++k) {
      const Vector3d wanted = draw_wanted(random, last);
      const Vector3d v = random.bits() % 3 == 0 ? Vector3d(0, 0, 0) : random.in_box(1.7);
      const double dt = random.bits() % 16 == 0 ? 0 : random.uniform(0, 0.01);
      const EnergyFlow flow{
          .work = random.uniform(-0.01, 0.01), .move_W = random.in_box(1e-3), .f_sent_W = last};
      const bool guarded = energy.stage != EnergyStage::kNone;
      const Vector3d sent =
          (guarded ? gate.pass_guarded(wanted, v, dt, flow) : gate.pass(wanted, v, dt)).f_T_W();
      const double rise = with.rise_max * dt;
      const double slack = 1e-12 * (1 + with.force_max);
      time += dt;
      ASSERT_EQ(gate.fault(), Fault::kNone);
      ASSERT_LE(distance_from_segment(sent, last), rise + slack) << sequence << " " << k;
      ASSERT_LE(sent.norm(), last.norm() + rise + slack);
      ASSERT_LE(sent.norm(),
                with.force_max * std::min(1.0, time / with.soft_start) * (1 + 1e-12) + 1e-15);
      if (energy.stage != EnergyStage::kPassivity) {
        ASSERT_LE(sent.norm(), wanted.norm() + slack);
      }
      last = sent;
    }
    limited += gate.counters().rise_limited;
    damped += gate.counters().damped;
  }
  EXPECT_GT(limited, 100'000U);
  EXPECT_GT(damped, 10'000U);
}

TEST(RiseLimit, NeverSlowsAFallAlongTheForcesOwnDirection) {
  support::Random random(17);
  for (int i = 0; i < 100'000; ++i) {
    GateLimits with = limits();
    with.rise_max = std::pow(10, random.uniform(1, 5));
    SafetyGate gate = support::open_gate(with);
    Vector3d last(0, 0, 0);
    const Vector3d wanted = random.in_box(4);
    for (int k = 0; k < 3; ++k) last = gate.pass(wanted, random.in_box(1), kPeriod).f_T_W();
    const Vector3d less = random.uniform(0, 1) * last;
    ASSERT_LE((gate.pass(less, random.in_box(1), kPeriod).f_T_W() - less).norm(), 1e-15 * 5);
  }
}

TEST(RiseLimit, TakesAtLeastTheWantedEnergy) {
  // In a tick, the gate may give the hand more power than the requested force only if removing the
  // whole old force and adding the allowed rise would do so too.
  support::Random random(18);
  int held = 0, dropped = 0;
  for (int i = 0; i < 100'000; ++i) {
    SafetyGate gate = support::open_gate();
    Vector3d last(0, 0, 0);
    const Vector3d first = random.in_box(4);
    for (int k = 0; k < 4; ++k) last = gate.pass(first, kStill, kPeriod).f_T_W();
    Vector3d wanted = random.in_box(5);
    wanted *= std::min(1.0, 5 / wanted.norm());
    const Vector3d v = random.in_box(1);
    const Vector3d sent = gate.pass(wanted, v, kPeriod).f_T_W();
    const double most = wanted.dot(v) + 1e-12;
    if (sent.dot(v) <= most) {
      held += sent != wanted;
      continue;
    }
    ++dropped;
    const double square = last.squaredNorm();
    const Vector3d near = std::clamp(wanted.dot(last) / square, 0.0, 1.0) * last;
    const Vector3d step = wanted - near;
    const Vector3d fresh = step.norm() > 2 ? Vector3d(near + 2 / step.norm() * step) : wanted;
    ASSERT_LE(sent.dot(v), fresh.dot(v) + 1e-12);
  }
  EXPECT_GT(held, 10'000);
  EXPECT_GT(dropped, 1000);
}

}  // namespace
}  // namespace thimble::driver::rise_limit_test
