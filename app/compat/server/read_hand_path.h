#pragma once

#include <filesystem>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/scene/hand_route.h"

namespace thimble::compat {

/// Reads the path of a simulated hand. Each line is a station: "t x y z" (s; m in the world: x to
/// the user, y to the user's right, z up), separated by blanks, commas or semicolons. Times
/// increase; text after # is a comment. A ROS bag is accepted too; its positions are used
/// (hand/bag_hand.h). The error names file and line. Real-time: never from the servo thread.
driver::Result<std::vector<scene::HandWaypoint>> read_hand_path(const std::filesystem::path& file);

}  // namespace thimble::compat
