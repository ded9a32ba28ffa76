#pragma once

#include <cstdint>

namespace thimble::compat {

/// Returns the hash of the layout of the memory that `thimble exec` shares with a program
/// (arm_channel.h). Builds with different hashes refuse each other. Real-time: safe.
std::uint64_t channel_layout_hash() noexcept;

}  // namespace thimble::compat
