#include "ros2/ros_reach.h"

#include <fmt/format.h>

#include <cstdlib>
#include <string>
#include <string_view>

namespace thimble::ros2 {
namespace {

std::string value_of(const char* variable) {
  const char* value = std::getenv(variable);
  return value != nullptr ? value : "";
}

}  // namespace

driver::Result<RosReach> ros_reach(bool network) {
  constexpr const char* kLocal = "ROS_LOCALHOST_ONLY";
  constexpr const char* kRange = "ROS_AUTOMATIC_DISCOVERY_RANGE";
  const std::string local = value_of(kLocal), range = value_of(kRange);
  std::string narrowed;  // the variable
  if (!local.empty() && local != "0" && local != "1") {
    return driver::Error{fmt::format("{}: expected 0 or 1, found \"{}\".", kLocal, local)};
  }
  if (local == "1") narrowed = fmt::format("{}=1", kLocal);
  if (range == "LOCALHOST" || range == "OFF") {
    narrowed = fmt::format("{}={}", kRange, range);
  } else if (!range.empty() && range != "SUBNET" && range != "SYSTEM_DEFAULT") {
    return driver::Error{fmt::format(
        "{}: expected LOCALHOST, SUBNET, OFF or SYSTEM_DEFAULT, found \"{}\".", kRange, range)};
  }
  if (network && !narrowed.empty()) {
    return driver::Error{fmt::format(
        "--ros-network allows other computers, but {} excludes them. Remove one.", narrowed)};
  }
  if (network) return RosReach::kNetwork;
  return range == "OFF" ? RosReach::kUnseen : RosReach::kThisComputer;
}

}  // namespace thimble::ros2
