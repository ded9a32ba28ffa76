#pragma once

#include <string_view>

namespace thimble::ros2 {

/// Returns the hash of a type, as ROS 2 compares it since Iron (RIHS01 of REP 2016). `dds_name`:
/// for example "geometry_msgs::msg::dds_::PoseStamped_". Empty for an unknown type. Real-time:
/// never from the servo thread.
std::string_view type_hash(std::string_view dds_name) noexcept;

}  // namespace thimble::ros2
