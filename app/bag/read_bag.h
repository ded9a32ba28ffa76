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

/// What a topic said at one time.
struct BagSample {
  double time = 0;                 ///< s, from the first.
  Eigen::Vector3d value{0, 0, 0};  ///< m or N, along the bag's axes; finite.
};

/// Whose times count.
enum class BagClock : std::uint8_t {
  kStamps,    ///< Those of the messages' headers; if all are zero, as `kReceived`.
  kReceived,  ///< When the recorder received them.
};

/// A topic of a bag in memory: one sample at least, times that grow, within a day.
struct BagTopic {
  std::string name;                    ///< "/pose"
  std::string frame;                   ///< Of all its messages; may be empty.
  BagClock clock = BagClock::kStamps;  ///< Whose times these are.
  std::int64_t start_ns = 0;           ///< When the first sample is, on that clock.
  std::vector<BagSample> samples;      ///< Oldest first.
};

/// Returns whether a path means a bag: a folder that holds one, or a file of one by name or first
/// bytes. Real-time: never from the servo thread.
THIMBLE_EXPORT bool is_bag(const std::filesystem::path& path);

/// Reads a topic of a ROS 2 bag in SQLite: the folder with all its files, or one .db3 file. An
/// empty `topic`: the only one of its kind, or else /pose or /wrench. Of messages with the same
/// time the first counts. The error is a sentence with what to do; no bytes of a bag do worse.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT driver::Result<BagTopic> read_bag(const std::filesystem::path& path, BagKind kind,
                                                 const std::string& topic = {},
                                                 BagClock clock = BagClock::kStamps);

}  // namespace thimble::bag
