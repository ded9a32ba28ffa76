#pragma once

#include <filesystem>
#include <string>

#include "bag/bag_axes.h"
#include "recording/replay_trajectory.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::session {

/// Topics of a bag to use.
struct BagTopics {
  std::string pose;  ///< Topic of poses; empty: the only one, or /pose.
  /// Topic of forces; empty: the only one, or /wrench if the bag has one.
  std::string wrench;
  bag::BagAxes axes = bag::BagAxes::kPlain;  ///< Axes of both topics.
};

/// Result of the replay of a bag.
struct BagReplay {
  TrajectoryReplay replay;
  bool has_forces = false;  ///< True if the bag has forces to compare with.
  double error_max = 0;     ///< Largest difference from these forces, N.
};

/// Moves a probe along the positions of a ROS bag through a scene, without arm or hand. Compares
/// the forces with those of the bag, which are interpolated linearly between its messages. The
/// error says how to fix the problem. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<BagReplay> replay_bag(const std::filesystem::path& bag,
                                                    const BagTopics& topics,
                                                    const std::filesystem::path& scene_file);

}  // namespace thimble::session
