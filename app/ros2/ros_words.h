#pragma once

#include <cstdint>
#include <string>

#include "ros2/ros_peer.h"
#include "thimble/driver/result.h"

namespace thimble::ros2 {

/// What a user says of the topics of a run, in words.
struct RosWords {
  std::string name_space = {};       ///< "/phantom"; empty: none, or the style's own
  std::string names = "plain";       ///< "plain", "crtk" or "omni"
  std::string force = "none";        ///< "none", "add" or "replace"
  std::string frames = "world,tip";  ///< names of the world's frame and of the tip's
  std::uint32_t domain = 0;          ///< ROS_DOMAIN_ID, below 233
  bool network = false;              ///< other computers may hear and be heard
  double stale_ms = 50;              ///< a force counts for so long, 1 to 1000 ms
  double force_limit = 0;            ///< N; 0: the arm's own
};

/// Returns what the words mean; the error says which is wrong and what to write instead.
driver::Result<RosOptions> ros_options(const RosWords& words);

}  // namespace thimble::ros2
