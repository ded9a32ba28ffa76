#pragma once

#include <cmath>
#include <cstdint>

namespace thimble::scene {

/// Converts a time of a file (s) to ns.
inline std::int64_t to_ns(double seconds) {
  return std::llround(seconds * 1e9);
}

}  // namespace thimble::scene
