#include "ros2/ros_option_strings.h"
#include "ros2/ros_reach.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <optional>
#include <string_view>

namespace thimble::ros2 {
namespace {

bool word(std::string_view text) {
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) == 0 &&
         std::all_of(text.begin(), text.end(),
                     [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; });
}

/// Returns whether a text is a ROS 2 namespace: words of letters, digits and "_", each after a
/// slash.
bool name_space(std::string_view text) {
  while (!text.empty()) {
    if (text.front() != '/') return false;
    const std::size_t end = std::min(text.find('/', 1), text.size());
    if (!word(text.substr(1, end - 1))) return false;
    text.remove_prefix(end);
  }
  return true;
}

std::optional<RosStyle> style_of(std::string_view names) {
  if (names == "plain") return RosStyle::kPlain;
  if (names == "crtk") return RosStyle::kCrtk;
  if (names == "omni") return RosStyle::kOmni;
  return {};
}

std::optional<RosForce> force_of(std::string_view force) {
  if (force == "none") return RosForce::kNone;
  if (force == "add") return RosForce::kAdd;
  if (force == "replace") return RosForce::kReplace;
  return {};
}

}  // namespace

driver::Result<RosOptions> ros_options(const RosOptionStrings& words) {
  RosOptions options;
  const auto style = style_of(words.names);
  if (!style) {
    return driver::Error{
        fmt::format("--ros-names: expected plain, crtk or omni, found \"{}\".", words.names)};
  }
  options.style = *style;
  const auto force = force_of(words.force);
  if (!force) {
    return driver::Error{
        fmt::format("--ros-force: expected none, add or replace, found \"{}\".", words.force)};
  }
  options.force = *force;
  options.name_space = words.name_space;
  if (*style == RosStyle::kOmni && words.name_space.empty()) options.name_space = "/phantom";
  if (!name_space(options.name_space)) {
    return driver::Error{fmt::format(
        "--ros-namespace: \"{}\" is not a ROS 2 name. Use words of letters, digits and _, each "
        "after a slash, as in /phantom.",
        options.name_space)};
  }
  const std::size_t comma = words.frames.find(',');
  options.world_frame = words.frames.substr(0, comma);
  options.tip_frame = comma == std::string::npos ? "" : words.frames.substr(comma + 1);
  for (const std::string& frame : {options.world_frame, options.tip_frame}) {
    if (frame.empty() || frame.size() > 100) {
      return driver::Error{"--ros-frames: the name of a frame must have 1 to 100 characters."};
    }
  }
  if (options.world_frame == options.tip_frame) {
    return driver::Error{"--ros-frames: expected two different names, as in world,tip."};
  }
  constexpr std::uint32_t kDomainMax = 232;  // [S OMG DDSI-RTPS 2.5, 9.6.1.1: ports end there]
  if (words.domain > kDomainMax) {
    return driver::Error{
        fmt::format("ROS_DOMAIN_ID: expected 0 to {}, found {}.", kDomainMax, words.domain)};
  }
  options.domain = words.domain;
  auto reach = ros_reach(words.network);
  if (!reach) return reach.error();
  options.reach = *reach;
  if (!(words.force_limit >= 0) || !std::isfinite(words.force_limit)) {
    return driver::Error{
        fmt::format("--ros-limit: expected a force of 0 N or more, found {}.", words.force_limit)};
  }
  options.force_limit = words.force_limit;
  if (!(words.stale_ms >= 1 && words.stale_ms <= 1000)) {
    return driver::Error{
        fmt::format("--ros-stale: expected 1 to 1000 ms, found {}.", words.stale_ms)};
  }
  options.stale_ns = std::llround(1e6 * words.stale_ms);
  return options;
}

}  // namespace thimble::ros2
