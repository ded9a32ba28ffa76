#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace thimble::ros2 {

/// Result of a check of a message.
enum class MessageVerdict : std::uint8_t { kGood, kNotFinite, kWrongFrame };

/// Returns whether a vector and the accompanying one are valid: both are finite, and in the world's
/// frame; an empty frame name means the world's frame. Real-time: safe.
MessageVerdict check_message(const std::array<double, 3>& taken,
                             const std::array<double, 3>& beside, std::string_view frame,
                             std::string_view world_frame) noexcept;

}  // namespace thimble::ros2
