#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bag/bag_messages.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"

namespace thimble::bag {

/// Value of a topic at one time.
struct BagSample {
  double time = 0;                 ///< Time from the first sample, s.
  Eigen::Vector3d value{0, 0, 0};  ///< Value, m or N, in the bag's axes; finite.
};

/// Source of the times.
enum class BagClock : std::uint8_t {
  kStamps,    ///< Stamps of the messages' headers; if all are zero, as `kReceived`.
  kReceived,  ///< Times at which the recorder received the messages.
};

/// Topic of a bag in memory: at least one sample, increasing times, at most a day.
struct BagTopic {
  std::string name;                    ///< Name, such as "/pose".
  std::string frame;                   ///< Frame of all messages; may be empty.
  BagClock clock = BagClock::kStamps;  ///< Source of the times.
  std::int64_t start_ns = 0;           ///< Time of the first sample on that clock, ns.
  std::vector<BagSample> samples;      ///< Samples, oldest first.
};

/// Returns whether a path is that of a bag: any folder, or a file with the name or the first bytes
/// of one. Real-time: never from the servo thread.
THIMBLE_EXPORT bool is_bag(const std::filesystem::path& path);

/// Reads a topic of a ROS 2 bag in SQLite: the folder with all its files, or one .db3 file. If
/// `topic` is empty: the only one of its kind, or else /pose or /wrench. Of messages with the same
/// time only the first is used. The error says what to do; a damaged bag causes an error only.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<BagTopic> read_bag(const std::filesystem::path& path, BagKind kind,
                                                 const std::string& topic = {},
                                                 BagClock clock = BagClock::kStamps);

}  // namespace thimble::bag
