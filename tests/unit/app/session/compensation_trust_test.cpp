#include "gravity/compensation_trust.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace thimble::session {
namespace {

constexpr double kTick = 1e-3;

/// Vertical motion of a tip, with or without a hand, and with possibly incorrect gravity
/// compensation.
struct Tip {
  double mass = 0.075, weight = 0.7, carried = 0.7, friction = 0.005;  // kg, N, N, N s/m
  double hand = 0;  ///< Force of the hand upwards, N.
  bool held = false;
  double z = 0, v = 0, fastest = 0, share = 1;
  CompensationTrust trust{};

  void run(double seconds) {
    driver::DeviceState state;
    for (int i = 0; i < static_cast<int>(seconds / kTick); ++i) {
      state.dt = kTick;
      state.p_WT = {0, 0, z};
      share = trust.share(state, {0, 0, carried}, false);
      if (!held) v += kTick / mass * (share * carried - weight + hand - friction * v);
      z += kTick * v;
      fastest = std::max(fastest, v);
    }
  }
};

TEST(CompensationTrust, CorrectCompensationIsFullFromTheFirstTick) {
  Tip tip;
  tip.run(5);
  EXPECT_EQ(tip.share, 1);
  EXPECT_EQ(tip.z, 0);
  EXPECT_EQ(tip.trust.withdrawn(), 0U);
}

TEST(CompensationTrust, WrongCompensationIsSwitchedOffOnTrial) {
  Tip tip{.carried = 1.9};  // 16 m/s^2 upwards
  tip.run(0.2);
  EXPECT_EQ(tip.trust.withdrawn(), 1U);
  EXPECT_EQ(tip.share, 0);
  EXPECT_LT(tip.z, 0.05);
  EXPECT_LT(tip.fastest, 1.0);
}

TEST(CompensationTrust, WrongCompensationHiddenByAHandIsSlow) {
  Tip tip{.carried = 1.9};
  tip.held = true;
  tip.run(3);
  EXPECT_EQ(tip.share, 1) << "a hand holds it still";
  tip.held = false;
  tip.run(0.5);
  EXPECT_LT(tip.fastest, CompensationTrust::kFadeEnds + 0.05);
}

TEST(CompensationTrust, ReturnsOnceTheTipRests) {
  Tip tip{.carried = 1.9};
  tip.run(0.2);
  ASSERT_EQ(tip.share, 0);
  tip.held = true;
  tip.v = 0;
  tip.run(0.4);
  EXPECT_EQ(tip.share, 0);
  tip.run(0.4);
  EXPECT_EQ(tip.share, 1);
}

TEST(CompensationTrust, SlowHandDoesNotSwitchItOff) {
  Tip tip;
  tip.run(1.1);
  tip.held = true;
  tip.v = 0.25;
  tip.run(0.6);
  EXPECT_EQ(tip.share, 1);
  EXPECT_EQ(tip.trust.withdrawn(), 0U);
}

TEST(CompensationTrust, IsFullAgainstTheMotion) {
  Tip tip;
  tip.run(1.1);
  tip.held = true;
  tip.v = -1.5;
  tip.run(0.2);
  EXPECT_EQ(tip.share, 1);
}

TEST(CompensationTrust, FadingAddsNoEnergyOverAStroke) {
  // For a stroke up and down at any speed, the force takes on the way down the energy that it gives
  // on the way up.
  for (const double speed : {0.1, 0.4, 0.8, 2.0}) {
    CompensationTrust trust;
    driver::DeviceState state;
    double z = 0, work = 0;
    for (int i = 0; i < 3000; ++i) {
      const double v = i < 1200 ? 0 : (i / 100 % 2 == 0 ? speed : -speed);
      state.dt = kTick;
      state.p_WT = {0, 0, z};
      work += trust.share(state, {0, 0, 1}, false) * v * kTick;
      z += v * kTick;
    }
    EXPECT_LT(work, 1e-9 + 0.02 * speed) << speed;
  }
}

TEST(CompensationTrust, AnotherForceExplainsTheMotion) {
  CompensationTrust trust;
  driver::DeviceState state;
  for (int i = 0; i < 500; ++i) {
    state.dt = kTick;
    state.p_WT.z() += 0.1 * kTick;
    trust.share(state, {0, 0, 1}, true);
  }
  EXPECT_EQ(trust.withdrawn(), 0U);
}

}  // namespace
}  // namespace thimble::session
