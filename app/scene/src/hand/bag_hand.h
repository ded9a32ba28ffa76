#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bag/bag_axes.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/scene/hand_route.h"

namespace thimble::scene {

/// Reads the path of a simulated hand from a ROS bag (bag/read_bag.h): one waypoint per message, at
/// least 10 ms apart, and the last message. Times are relative to the first message. `axes`: those
/// of the bag. Fails if a position is beyond 2 m or the bag lasts more than a day. The error says
/// how to fix the problem. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<std::vector<HandWaypoint>> read_bag_hand(
    const std::filesystem::path& bag, const std::string& topic, bag::BagAxes axes);

}  // namespace thimble::scene
