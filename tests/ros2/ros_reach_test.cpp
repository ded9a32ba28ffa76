#include "ros2/ros_reach.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <string>

#include "ros2/ros_option_strings.h"

namespace thimble::ros2 {
namespace {

/// Tests without the ROS 2 variables in their environment.
class RosReachTest : public ::testing::Test {
 protected:
  void SetUp() override {
    unsetenv("ROS_LOCALHOST_ONLY");
    unsetenv("ROS_AUTOMATIC_DISCOVERY_RANGE");
  }
  void TearDown() override { SetUp(); }
};

TEST_F(RosReachTest, IsThisComputerByDefault) {
  EXPECT_EQ(ros_reach(false).value(), RosReach::kThisComputer);
  EXPECT_EQ(ros_options({}).value().reach, RosReach::kThisComputer);
}

TEST_F(RosReachTest, NetworkMustBeRequested) {
  EXPECT_EQ(ros_reach(true).value(), RosReach::kNetwork);
  EXPECT_EQ(ros_options({.network = true}).value().reach, RosReach::kNetwork);
}

TEST_F(RosReachTest, VariablesCannotEnableTheNetwork) {
  setenv("ROS_LOCALHOST_ONLY", "0", 1);
  for (const char* range : {"SUBNET", "SYSTEM_DEFAULT", ""}) {
    setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", range, 1);
    EXPECT_EQ(ros_reach(false).value(), RosReach::kThisComputer) << range;
  }
}

TEST_F(RosReachTest, NetworkAgainstLocalhostOnlyIsRefused) {
  setenv("ROS_LOCALHOST_ONLY", "1", 1);
  const auto reach = ros_reach(true);
  ASSERT_FALSE(reach);
  EXPECT_NE(reach.error().message.find("ROS_LOCALHOST_ONLY=1"), std::string::npos);
}

TEST_F(RosReachTest, NetworkAgainstNarrowRangeIsRefused) {
  for (const char* range : {"LOCALHOST", "OFF"}) {
    setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", range, 1);
    EXPECT_FALSE(ros_reach(true)) << range;
  }
}

TEST_F(RosReachTest, RangeOffIsUnseen) {
  setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF", 1);
  EXPECT_EQ(ros_reach(false).value(), RosReach::kUnseen);
}

TEST_F(RosReachTest, UnknownValueIsRefused) {
  setenv("ROS_AUTOMATIC_DISCOVERY_RANGE", "local", 1);
  const auto range = ros_reach(false);
  ASSERT_FALSE(range);
  EXPECT_NE(range.error().message.find("\"local\""), std::string::npos);
  unsetenv("ROS_AUTOMATIC_DISCOVERY_RANGE");
  setenv("ROS_LOCALHOST_ONLY", "yes", 1);
  EXPECT_FALSE(ros_reach(false));
}

}  // namespace
}  // namespace thimble::ros2
