// Forces that the energy stage lowers and forces that it leaves unchanged: forces of storages that
// a law names, forces of programs, and unexplained energy.

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "support/explained_rig.h"
#include "support/random.h"
#include "support/seed.h"

namespace thimble::driver {
namespace {

using Eigen::Vector3d;
using support::explained_limits;
using support::explained_stage;
using support::ExplainedRig;

constexpr double kTick = ExplainedRig::kTick;

/// A spring to the origin, N/m, as a field that reports its energy.
ForceCommand spring(double stiffness, const Vector3d& p_W) {
  ForceCommand command;
  command.f_T_W = -stiffness * p_W;
  command.stored = 1e-3 + stiffness / 2 * p_W.squaredNorm();
  return command;
}

/// A weight, N, with its potential energy.
ForceCommand weight(const Vector3d& f_W, const Vector3d& p_W) {
  ForceCommand command;
  command.f_T_W = f_W;
  command.stored = 1 - f_W.dot(p_W);
  return command;
}

/// An endless path: random accelerations, within a sphere of 60 mm and below 0.5 m/s.
class RandomPath {
 public:
  explicit RandomPath(std::uint64_t seed) : random_(seed) {}
  Vector3d next() {
    if (left_-- <= 0) {
      left_ = static_cast<int>(random_.uniform(5, 200));
      push_ = random_.in_box(10);
    }
    v_ += kTick * (push_ - 300 * p_ - 2 * v_);
    if (v_.norm() > 0.5) v_ *= 0.5 / v_.norm();
    p_ += kTick * v_;
    return p_;
  }

 private:
  support::Random random_;
  Vector3d p_{0, 0, 0}, v_{0, 0, 0}, push_{0, 0, 0};
  int left_ = 0;
};

TEST(ExplainedEnergy, AWeightPassesOnAMillionRandomTicks) {
  ExplainedRig rig(explained_limits(), explained_stage());
  RandomPath path(support::seed_of(1));
  rig.open({0, 0, 0});
  const Vector3d f_W{0, 0, -0.2 * 9.80665};
  int changed = 0;
  for (int k = 0; k < 1'000'000; ++k) {
    const Vector3d p_W = path.next();
    changed += rig.tick(p_W, weight(f_W, p_W)) == f_W ? 0 : 1;
  }
  EXPECT_EQ(changed, 0);
}

TEST(ExplainedEnergy, AFieldPassesOnAMillionRandomTicks) {
  // The largest stiffness for which the damping of arm and hand pays: K (T / 2 + T) = b.
  const double stiffness = 0.99 * explained_stage().dissipation / (1.5 * kTick);
  ExplainedRig rig(explained_limits(), explained_stage());
  RandomPath path(support::seed_of(2));
  rig.open({0, 0, 0});
  int changed = 0;
  for (int k = 0; k < 1'000'000; ++k) {
    const Vector3d p_W = path.next() / 20;
    changed += rig.tick(p_W, spring(stiffness, p_W)) == -stiffness * p_W ? 0 : 1;
  }
  EXPECT_EQ(changed, 0);
  EXPECT_GT(rig.gate().energy(), -1e-12);
}

TEST(ExplainedEnergy, StifferFieldIsDampedByItsEnergyGain) {
  // Shows that the test above can fail.
  ExplainedRig rig(explained_limits(), explained_stage());
  rig.open({0, 0, 0});
  int k = 0;
  for (; k < 100'000; ++k) {
    const double angle = 2 * std::numbers::pi * 5 * k * kTick;
    const Vector3d p_W{2e-3 * std::sin(angle), 0, 0};
    rig.tick(p_W, spring(2000, p_W));
  }
  EXPECT_GT(rig.gate().counters().damped, 1000u);
  const EnergyGuardSettings stage = explained_stage();
  EXPECT_LT(rig.work() - rig.dissipated(),
            stage.reservoir + stage.allowance + 2 * stage.onset + 2000 * 4e-6 / 2);
}

TEST(ExplainedEnergy, ClosedLoopsOfAWeightLoseNothing) {
  ExplainedRig rig(explained_limits(), explained_stage());
  rig.open({0.03, 0, 0});
  const Vector3d f_W{0.5, -1, -1.5};
  const double begin = rig.work();
  for (int k = 0; k <= 600'000; ++k) {  // ten minutes, one loop in two seconds
    const double angle = std::numbers::pi * k * kTick;
    const Vector3d p_W{0.03 * std::cos(angle), 0.02 * std::sin(angle), 0.02 * std::sin(2 * angle)};
    ASSERT_EQ(rig.tick(p_W, weight(f_W, p_W)), f_W);
  }
  EXPECT_NEAR(rig.work(), begin, 1e-3);
}

/// Leads the tip around in a circular force field, which has no potential. Returns the work (J) on
/// the hand in excess of the dissipation by damping.
double swirled(double stored_slope) {
  ExplainedRig rig(explained_limits(), explained_stage());
  rig.open({0.02, 0, 0});
  for (int k = 0; k < 20'000; ++k) {
    const double angle = 2 * std::numbers::pi * k * kTick;
    const Vector3d p_W{0.02 * std::cos(angle), 0.02 * std::sin(angle), 0};
    ForceCommand command;
    command.f_T_W = 1.5 * Vector3d(-std::sin(angle), std::cos(angle), 0);
    command.stored = 1 + stored_slope * p_W.x();
    rig.tick(p_W, command);
  }
  return rig.work() - rig.dissipated();
}

TEST(ExplainedEnergy, UnexplainedEnergyIsBounded) {
  const EnergyGuardSettings stage = explained_stage();
  const double tick = 1.5 * 0.13 * 2 * kTick;  // and the delay
  EXPECT_LE(swirled(0), stage.allowance + 2 * stage.onset + tick);
  // A storage that gains 20 mJ from another source in each of 20 rounds explains only this energy.
  EXPECT_LE(swirled(0.5), 20 * 0.02 + stage.reservoir + stage.allowance + 2 * stage.onset + tick);
}

TEST(ExplainedEnergy, FallingStoragePaysForWorkOnAnotherHand) {
  PassivityObserver observer(explained_stage());
  // Another hand lifts a body: this adds no debt to this hand.
  observer.book({.stored_change = 0.5});
  EXPECT_EQ(observer.energy(), 0);
  // The body falls onto this hand.
  observer.book({.work = 0.5, .stored_change = -0.5});
  EXPECT_NEAR(observer.energy(), 0, 1e-15);
  // Without a storage, the same work is a debt.
  observer.book({.work = 0.5});
  EXPECT_NEAR(observer.energy(), -0.5, 1e-15);
}

TEST(ExplainedEnergy, HandPaysForEnergyThatItStores) {
  PassivityObserver observer(explained_stage());
  observer.book({.work = -0.01, .stored_change = 0.008});
  EXPECT_NEAR(observer.energy(), 0.002, 1e-15);
  observer.book({.stored_change = -1});
  EXPECT_EQ(observer.energy(), explained_stage().reservoir);
}

// Programs.

ForceCommand asked_by_program(const Vector3d& f_W) {
  ForceCommand command;
  command.f_T_W = command.f_program_W = f_W;
  return command;
}

TEST(ProgramForce, AConstantForcePassesForAnyTime) {
  ExplainedRig rig(explained_limits(), explained_stage());
  rig.open({0, 0, 0});
  const Vector3d f_W{0, 0, 3};
  int changed = 0;
  for (int k = 0; k < 600'000; ++k) {
    // The hand moves with the force and back, across the whole workspace.
    const Vector3d p_W{0, 0, 0.1 * std::sin(std::numbers::pi * k * kTick)};
    changed += rig.tick(p_W, asked_by_program(f_W)) == f_W ? 0 : 1;
  }
  EXPECT_EQ(changed, 0);
}

TEST(ProgramForce, AVibrationPassesAtEachFrequency) {
  for (const double frequency : {5.0, 10.0, 20.0, 40.0, 80.0, 150.0, 250.0, 300.0}) {
    for (const double amplitude : {0.2, 1.05, 2.0}) {
      ExplainedRig rig(explained_limits(), explained_stage());
      rig.open({0, 0, 0});
      // A held arm of 0.1 kg responds: x'' = (f - 3 v - 300 x) / m.
      double x = 0, v = 0, worst = 0;
      for (int k = 0; k < 5000; ++k) {
        const double f = amplitude * std::sin(2 * std::numbers::pi * frequency * k * kTick);
        const double sent = rig.tick({x, 0, 0}, asked_by_program({f, 0, 0})).x();
        worst = std::max(worst, std::abs(sent - f));
        for (int i = 0; i < 20; ++i) {
          v += kTick / 20 * (rig.felt_W().x() - 3 * v - 300 * x) / 0.1;
          x += kTick / 20 * v;
        }
      }
      EXPECT_EQ(worst, 0) << frequency << " Hz, " << amplitude << " N";
    }
  }
}

TEST(ProgramForce, LeavesTheSceneItsEnergyStage) {
  // The circular field of a scene is damped and fades; the constant force of a program remains.
  ExplainedRig rig(explained_limits(), explained_stage());
  rig.open({0.02, 0, 0});
  Vector3d sent_W{0, 0, 0};
  for (int k = 0; k < 20'000; ++k) {
    const double angle = 2 * std::numbers::pi * k * kTick;
    const Vector3d p_W{0.02 * std::cos(angle), 0.02 * std::sin(angle), 0};
    ForceCommand command = asked_by_program({0, 0, 2});
    command.f_T_W += 1.5 * Vector3d(-std::sin(angle), std::cos(angle), 0);
    sent_W = rig.tick(p_W, command);
  }
  EXPECT_NEAR(sent_W.z(), 2, 0.02);
  EXPECT_LT(std::hypot(sent_W.x(), sent_W.y()), 0.3);
}

TEST(PowerLimit, LowersAForceThatPushesContinuously) {
  // A program that always pushes in the direction of motion: 3 N at 0.6 m/s are 1.8 W.
  ExplainedRig rig(explained_limits(), explained_stage());
  rig.open({0.04, 0, 0});
  double last = 0;
  for (int k = 0; k < 40'000; ++k) {
    const double angle = 15 * k * kTick;
    const Vector3d p_W{0.04 * std::cos(angle), 0.04 * std::sin(angle), 0};
    const Vector3d along{-std::sin(angle), std::cos(angle), 0};
    last = rig.tick(p_W, asked_by_program(3 * along)).norm();
  }
  const GateLimits limits = explained_limits();
  EXPECT_LE(rig.gate().counters().power_max, GateLimits::kPowerFade * limits.power_max);
  EXPECT_GT(rig.gate().counters().power_limited, 10'000u);
  EXPECT_LT(0.6 * last, GateLimits::kPowerFade * limits.power_max);
  EXPECT_GT(0.6 * last, 0.9 * limits.power_max);
}

TEST(PowerLimit, IsOffUnlessSet) {
  GateLimits limits = explained_limits();
  limits.power_max = 0;
  SafetyGate gate(limits);
  for (int k = 0; k < 100'000; ++k) gate.book_power(1, kTick);
  for (int k = 0; k < 100; ++k) gate.pass({1, 0, 0}, {0, 0, 0}, kTick);
  EXPECT_EQ(gate.pass({1, 0, 0}, {0, 0, 0}, kTick).f_T_W().x(), 1);
  EXPECT_EQ(gate.counters().power_limited, 0u);
}

TEST(PowerLimit, IgnoresWorkThatIsNotFinite) {
  SafetyGate gate(explained_limits());
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) gate.book_power(bad, kTick);
  gate.book_power(1, std::nan(""));
  EXPECT_EQ(gate.power(), 0);
}

}  // namespace
}  // namespace thimble::driver
