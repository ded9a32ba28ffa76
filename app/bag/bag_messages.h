#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace thimble::bag {

// ROS 2 messages as stored in a bag: CDR after a header of four bytes that gives the byte order [S
// OMG DDSI-RTPS 2.5, 10.5]. Each number is aligned to its size. Real-time: never from the servo
// thread.

/// Kind of a message with a vector.
enum class BagKind : std::uint8_t {
  kPositions,  ///< geometry_msgs/msg/PoseStamped: the position of its pose, m.
  kForces,     ///< geometry_msgs/msg/WrenchStamped: the force of its wrench, N.
};

/// Returns the ROS 2 message type of a kind.
std::string_view type_of(BagKind kind) noexcept;

/// Part of a message that is read.
struct StampedVector {
  std::int64_t stamp_ns = 0;       ///< Stamp of the header, from the epoch or another start.
  std::string frame;               ///< Frame of the vector.
  Eigen::Vector3d value{0, 0, 0};  ///< m or N.
};

/// Reads a message; empty if the bytes are not a message of this kind. The vector may contain any
/// number, also NaN.
std::optional<StampedVector> decode(BagKind kind, std::span<const unsigned char> bytes);

/// Writes a message in little-endian order. `q`: the rotation of a pose (w, x, y, z); the torque of
/// a wrench is zero. Precondition: stamp_ns is in the range of ROS 2, up to 2^31 s.
std::vector<unsigned char> encode(BagKind kind, const StampedVector& message,
                                  const std::array<double, 4>& q = {1, 0, 0, 0});

}  // namespace thimble::bag
