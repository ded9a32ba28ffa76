#include "compact_mesh/wide_lanes.h"

#include <cstdlib>

namespace thimble::render {

bool wide_lanes() noexcept {
  static const bool wide = [] {
    if (std::getenv("THIMBLE_PLAIN_LANES") != nullptr) return false;
#if defined(__x86_64__)
    return __builtin_cpu_supports("avx2") != 0;
#else
    return false;
#endif
  }();
  return wide;
}

}  // namespace thimble::render
