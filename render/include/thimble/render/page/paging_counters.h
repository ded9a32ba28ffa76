#pragma once

#include <cstdint>

namespace thimble::render {

/// What paging did for a mesh of which only a part is in memory.
struct PagingCounters {
  std::uint64_t loads = 0;      ///< Pages read from the disk.
  std::uint64_t evictions = 0;  ///< Pages given up for others.
  std::uint64_t failures = 0;   ///< Pages that could not be read or are damaged; they stay absent.
  std::uint64_t misses = 0;     ///< Ticks that needed a page which was absent.
  std::uint64_t short_of_frames = 0;  ///< Times that more pages were wanted than there are frames.
};

}  // namespace thimble::render
