#pragma once

#include "ros2/ros_peer.h"
#include "thimble/driver/result.h"

namespace thimble::ros2 {

/// Returns how far the topics of a run go: to this computer only, unless `network` asks for more.
/// The variables of ROS 2 (ROS_LOCALHOST_ONLY, ROS_AUTOMATIC_DISCOVERY_RANGE) can only narrow that;
/// where they contradict `network`, or have a value that ROS 2 does not know, the error says so.
driver::Result<RosReach> ros_reach(bool network);

}  // namespace thimble::ros2
