#pragma once

#include <cstdint>
#include <string>

#include "ros2/ros_peer.h"
#include "thimble/driver/result.h"

namespace thimble::ros2 {

/// The user's options for the topics of a run, as words.
struct RosOptionStrings {
  std::string name_space = {};       ///< "/phantom"; empty: none, or the default of the style
  std::string names = "plain";       ///< "plain", "crtk" or "omni"
  std::string force = "none";        ///< "none", "add" or "replace"
  std::string frames = "world,tip";  ///< names of the world's frame and of the tip's
  std::uint32_t domain = 0;          ///< ROS_DOMAIN_ID, below 233
  bool network = false;              ///< also visible to other computers
  double stale_ms = 50;              ///< maximum age of a force, 1 to 1000 ms
  double force_limit = 0;            ///< N; 0: the arm's own limit
};

/// Parses the words. The error names the wrong one and the allowed values.
driver::Result<RosOptions> ros_options(const RosOptionStrings& words);

}  // namespace thimble::ros2
