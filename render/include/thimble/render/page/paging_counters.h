#pragma once

#include <cstdint>

namespace thimble::render {

/// Disk paging counters of a mesh that is only partly in memory.
struct PagingCounters {
  std::uint64_t loads = 0;      ///< Number of pages read from disk.
  std::uint64_t evictions = 0;  ///< Number of pages evicted for others.
  /// Number of pages that are unreadable or damaged; they stay absent.
  std::uint64_t failures = 0;
  std::uint64_t misses = 0;  ///< Number of ticks that needed an absent page.
  /// Number of times that more pages were requested than frames exist.
  std::uint64_t short_of_frames = 0;
};

}  // namespace thimble::render
