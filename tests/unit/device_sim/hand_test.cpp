#include "hand/hand.h"

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

namespace thimble::device_sim {
namespace {

constexpr std::int64_t kMs = 1'000'000;

HandPath straight() {
  return HandPath::make({{0, {0, 0, 0}}, {1, {0.1, 0, 0}}}).value();
}

const Tremor kSteady = Tremor::make({}, 0).value();

TEST(Hand, FollowsItsPathUntilItIsLed) {
  Hand hand(straight(), kSteady);
  EXPECT_DOUBLE_EQ(hand.at(500 * kMs).x(), 0.05);
  hand.lead({0.05, 0.02, 0});
  EXPECT_NEAR(hand.at(501 * kMs).x(), 0.05, 1e-12);
  EXPECT_LT((hand.at(2000 * kMs) - Eigen::Vector3d(0.05, 0.02, 0)).norm(), 1e-9);
}

TEST(Hand, LimitsItsSpeedAndNeverJumps) {
  Hand hand(straight(), kSteady);
  Eigen::Vector3d before = hand.at(0);
  Eigen::Vector3d v_before(0, 0, 0);
  for (int i = 1; i < 4000; ++i) {
    // The mouse is moved violently.
    hand.lead({i / 700 % 2 == 0 ? 0.5 : -0.5, i / 300 % 2 == 0 ? 0.0 : 0.3, 0});
    const Eigen::Vector3d now = hand.at(i * kMs);
    const Eigen::Vector3d v = (now - before) / 1e-3;
    EXPECT_LE(v.norm(), 1.0001 * Hand::kSpeedMax) << i;
    // Twice the acceleration, if it reverses at full speed.
    EXPECT_LE((v - v_before).norm() / 1e-3, 4.01 * Hand::kQuickness * Hand::kSpeedMax) << i;
    before = now;
    v_before = v;
  }
}

TEST(Hand, ComesToItsPointWithoutOvershoot) {
  Hand hand(straight(), kSteady);
  hand.lead({0.2, 0, 0});
  double before = 0;
  for (int i = 1; i < 3000; ++i) {
    const double x = hand.at(i * kMs).x();
    EXPECT_GE(x, before);
    EXPECT_LE(x, 0.2);
    before = x;
  }
  EXPECT_NEAR(before, 0.2, 1e-9);
}

TEST(Hand, PausesWhileHeldAndContinuesFromThere) {
  Hand hand(straight(), kSteady);
  const double here = hand.at(300 * kMs).x();
  hand.hold(true);
  EXPECT_DOUBLE_EQ(hand.at(800 * kMs).x(), here);
  hand.hold(false);
  EXPECT_DOUBLE_EQ(hand.at(800 * kMs).x(), here);
  EXPECT_NEAR(hand.at(900 * kMs).x(), here + 0.01, 1e-12);
  // A led hand also pauses.
  hand.lead({0.1, 0.1, 0});
  hand.at(920 * kMs);
  const Eigen::Vector3d led = hand.at(921 * kMs);
  hand.hold(true);
  EXPECT_EQ(hand.at(1500 * kMs), led);
}

TEST(Hand, IgnoresAPointThatIsNotFinite) {
  Hand hand(straight(), kSteady);
  hand.lead({std::numeric_limits<double>::quiet_NaN(), 0, 0});
  EXPECT_DOUBLE_EQ(hand.at(500 * kMs).x(), 0.05) << "still on its path";
}

}  // namespace
}  // namespace thimble::device_sim
