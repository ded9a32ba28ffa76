#include "hand/hand_path.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "support/random.h"
#include "support/refuses.h"

namespace thimble::device_sim {
namespace {

using support::refuses;

HandPath zigzag() {
  return HandPath::make({{1.0, {0, 0, 0}}, {2.0, {1, 0, -2}}, {4.0, {0, 3, 0}}, {4.5, {0, 3, 1}}})
      .value();
}

TEST(HandPath, JoinsItsPointsByStraightLines) {
  HandPath path = zigzag();
  EXPECT_EQ(path.at(1.5), Eigen::Vector3d(0.5, 0, -1));
  EXPECT_EQ(path.at(2.0), Eigen::Vector3d(1, 0, -2));
  EXPECT_EQ(path.at(3.0), Eigen::Vector3d(0.5, 1.5, -1));
  EXPECT_EQ(path.at(4.25), Eigen::Vector3d(0, 3, 0.5));
}

TEST(HandPath, WaitsBeforeItsFirstAndAfterItsLastPoint) {
  HandPath path = zigzag();
  EXPECT_EQ(path.at(-10), Eigen::Vector3d(0, 0, 0));
  EXPECT_EQ(path.at(1e9), Eigen::Vector3d(0, 3, 1));
  EXPECT_EQ(path.at(std::numeric_limits<double>::quiet_NaN()), Eigen::Vector3d(0, 0, 0));
  HandPath still = HandPath::make({{0.0, {1, 2, 3}}}).value();
  EXPECT_EQ(still.at(-1), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(still.at(1), Eigen::Vector3d(1, 2, 3));
}

TEST(HandPath, PositionIsIndependentOfEarlierQueries) {
  HandPath wandering = zigzag();
  support::Random random(7);
  for (int i = 0; i < 1000; ++i) {
    const double time = random.uniform(0, 5);
    HandPath fresh = zigzag();
    ASSERT_EQ(wandering.at(time), fresh.at(time)) << time;
  }
}

TEST(HandPath, RefusesPointsOutOfOrderAndNamesThem) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(refuses(HandPath::make({}), "at least one point"));
  EXPECT_TRUE(refuses(HandPath::make({{0.0, {nan, 0, 0}}}), "Point 0"));
  EXPECT_TRUE(refuses(HandPath::make({{nan, {0, 0, 0}}}), "not finite"));
  EXPECT_TRUE(refuses(HandPath::make({{0.0, {0, 0, 0}}, {1.0, {0, 0, 0}}, {1.0, {0, 0, 0}}}),
                      "Point 2 of the hand's path is not later than the point before it"));
}

}  // namespace
}  // namespace thimble::device_sim
