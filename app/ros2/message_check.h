#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace thimble::ros2 {

/// What is said of a message that came.
enum class MessageVerdict : std::uint8_t { kGood, kNotFinite, kWrongFrame };

/// Returns whether a vector and what came with it may be taken: both are finite, and in the world's
/// frame, of which an empty name means the same. Real-time: safe.
MessageVerdict check_message(const std::array<double, 3>& taken,
                             const std::array<double, 3>& beside, std::string_view frame,
                             std::string_view world_frame) noexcept;

}  // namespace thimble::ros2
