#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "bag/bag_messages.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::bag {

/// Message to write.
struct BagMessage {
  std::int64_t time_ns = 0;             ///< Time of the stamp and of reception, ns; >= 0.
  Eigen::Vector3d value{0, 0, 0};       ///< Value, m or N.
  std::array<double, 4> q{1, 0, 0, 0};  ///< Rotation of a pose (w, x, y, z).
};

/// Topic to write.
struct BagTrack {
  std::string name;                    ///< Name, such as "/pose".
  BagKind kind = BagKind::kPositions;  ///< Kind of all messages.
  std::string frame = "world";         ///< Frame of all messages.
  std::vector<BagMessage> messages;    ///< Messages with increasing times.
};

/// Writes a ROS 2 bag in SQLite for `ros2 bag play` of Humble: a folder with metadata.yaml (version
/// 5) and one .db3 file with the folder's name. The folder must not exist yet, or be empty. The
/// error says what cannot be written. `share_written`, if any, is called with the share of the
/// messages that are written. Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<void> write_bag(
    const std::filesystem::path& folder, const std::vector<BagTrack>& tracks,
    const std::function<void(double)>& share_written = {});

}  // namespace thimble::bag
