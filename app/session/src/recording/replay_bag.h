#pragma once

#include <filesystem>
#include <string>

#include "bag/bag_axes.h"
#include "recording/replay_trajectory.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// Which topics of a bag are meant.
struct BagTopics {
  std::string pose;    ///< Empty: the only one, or /pose.
  std::string wrench;  ///< Empty: the only one, or /wrench, where the bag has one.
  bag::BagAxes axes = bag::BagAxes::kPlain;  ///< Of both.
};

/// A bag whose positions touched a scene.
struct BagReplay {
  TrajectoryReplay replay;
  bool has_forces = false;  ///< The bag had forces to compare with.
  double error_max = 0;     ///< Of all differences from them, N.
};

/// Lets a probe go along the positions of a ROS bag and touch a scene, without arm or hand, and
/// compares with the bag's forces, taken linearly between its messages. The error says what to
/// mend. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<BagReplay> replay_bag(const std::filesystem::path& bag,
                                                    const BagTopics& topics,
                                                    const std::filesystem::path& scene_file);

}  // namespace thimble::session
