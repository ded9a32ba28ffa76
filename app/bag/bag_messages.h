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

// Messages of ROS 2 as they lie in a bag: CDR behind four bytes that tell the order of bytes [S OMG
// DDSI-RTPS 2.5, 10.5], each number aligned to its size. Real-time: never from the servo thread.

/// Which of the messages that hold a vector.
enum class BagKind : std::uint8_t {
  kPositions,  ///< geometry_msgs/msg/PoseStamped: of its pose the position, m.
  kForces,     ///< geometry_msgs/msg/WrenchStamped: of its wrench the force, N.
};

/// Returns the type of a kind's messages, as ROS 2 names it.
std::string_view type_of(BagKind kind) noexcept;

/// What of a message is read.
struct StampedVector {
  std::int64_t stamp_ns = 0;       ///< Of the header, since the epoch or another start.
  std::string frame;               ///< In which the vector is told.
  Eigen::Vector3d value{0, 0, 0};  ///< m or N.
};

/// Reads a message; empty if the bytes are none of this kind. The vector may hold any number, NaN
/// too.
std::optional<StampedVector> decode(BagKind kind, std::span<const unsigned char> bytes);

/// Writes a message, in little-endian order. `q`: of a pose the rotation (w, x, y, z); a wrench has
/// no torque. Precondition: stamp_ns is in the range of ROS 2, up to 2^31 s.
std::vector<unsigned char> encode(BagKind kind, const StampedVector& message,
                                  const std::array<double, 4>& q = {1, 0, 0, 0});

}  // namespace thimble::bag
