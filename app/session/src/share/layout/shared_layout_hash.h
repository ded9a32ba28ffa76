#pragma once

#include <cstdint>

namespace thimble::session {

/// Returns the hash of the layout of the memory that a run shares with its viewers
/// (shared_layout.h). Builds with the same hash can read each other's memory; others refuse.
/// Real-time: safe.
std::uint64_t shared_layout_hash() noexcept;

}  // namespace thimble::session
