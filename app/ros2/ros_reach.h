#pragma once

#include "ros2/ros_peer.h"
#include "thimble/driver/result.h"

namespace thimble::ros2 {

/// Returns the visibility of a run's topics: only this computer, unless `network` requests more.
/// The variables of ROS 2 (ROS_LOCALHOST_ONLY, ROS_AUTOMATIC_DISCOVERY_RANGE) can only narrow it.
/// The error reports a variable that contradicts `network` or has a value unknown to ROS 2.
driver::Result<RosReach> ros_reach(bool network);

}  // namespace thimble::ros2
