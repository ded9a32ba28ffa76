#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bag/bag_messages.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::bag {

/// A message to write.
struct BagMessage {
  std::int64_t time_ns = 0;             ///< Of the stamp, and when it counts as received; >= 0.
  Eigen::Vector3d value{0, 0, 0};       ///< m or N.
  std::array<double, 4> q{1, 0, 0, 0};  ///< Of a pose the rotation (w, x, y, z).
};

/// A topic to write.
struct BagTrack {
  std::string name;                    ///< "/pose"
  BagKind kind = BagKind::kPositions;  ///< Of all its messages.
  std::string frame = "world";         ///< In which they are told.
  std::vector<BagMessage> messages;    ///< Times that grow.
};

/// Writes a ROS 2 bag in SQLite as `ros2 bag play` of Humble reads it: a folder with metadata.yaml
/// (version 5) and one .db3 file of the folder's name. The folder must not be there yet, or be
/// empty. The error says what cannot be written. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<void> write_bag(const std::filesystem::path& folder,
                                              const std::vector<BagTrack>& tracks);

}  // namespace thimble::bag
