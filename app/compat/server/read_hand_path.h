#pragma once

#include <filesystem>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/scene/hand_route.h"

namespace thimble::compat {

/// A simulated hand from a file: its path, and the buttons that it holds.
struct HandFile {
  std::vector<scene::HandWaypoint> path;   ///< Stations, in order of time.
  std::vector<scene::ButtonStep> buttons;  ///< Empty: the file has no buttons.
};

/// Reads a simulated hand. Each line is a station: "t x y z [buttons]" (s; m in the world: x to the
/// user, y to the user's right, z up; sum of 1 for the first button, 2 for the second, 4 and so
/// on), separated by blanks, commas or semicolons. Buttons hold until the next line; without the
/// fifth number, none is pressed. Times increase; text after # is a comment. A ROS bag is accepted
/// too; its positions are used (hand/bag_hand.h). The error names file and line. Real-time: never
/// from the servo thread.
driver::Result<HandFile> read_hand_path(const std::filesystem::path& file);

}  // namespace thimble::compat
