#pragma once

#include <string_view>

namespace thimble::ros2 {

/// Returns the hash of a type as ROS 2 from Iron on compares it (RIHS01 of REP 2016), by the type's
/// name in DDS, as "geometry_msgs::msg::dds_::PoseStamped_"; empty for a type that is none of ours.
/// Real-time: never from the servo thread.
std::string_view type_hash(std::string_view dds_name) noexcept;

}  // namespace thimble::ros2
