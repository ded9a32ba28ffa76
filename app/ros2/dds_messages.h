#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "ros_messages.h"

namespace thimble::ros2 {

// Helpers that compose messages. DDS reads a message while it is written and does not change it,
// although its C types have no const.

/// Refers to a text, which must outlive the message.
inline char* dds_text(const std::string& s) noexcept {
  return const_cast<char*>(s.c_str());
}

/// Refers to items as a sequence of DDS; they must outlive it.
template <class Sequence, class Items>
Sequence dds_sequence(Items& items, std::size_t size) noexcept {
  const auto length = static_cast<std::uint32_t>(size);
  return {._maximum = length, ._length = length, ._buffer = items.data(), ._release = false};
}

inline geometry_msgs_msg_dds__Vector3_ dds_vector(const std::array<double, 3>& v) noexcept {
  return {v[0], v[1], v[2]};
}

/// Converts a rotation from w, x, y, z.
inline geometry_msgs_msg_dds__Quaternion_ dds_quaternion(const std::array<double, 4>& q) noexcept {
  return {q[1], q[2], q[3], q[0]};
}

/// Converts a time (ns) to seconds and nanoseconds.
inline builtin_interfaces_msg_dds__Time_ stamp_of(std::int64_t ns) noexcept {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  return {static_cast<std::int32_t>(ns / kSecond_ns), static_cast<std::uint32_t>(ns % kSecond_ns)};
}

}  // namespace thimble::ros2
