#pragma once

#include <cstdint>

namespace thimble::render {

/// What of a surface a point lies on: the inside of a face, an edge with its two faces, or a
/// corner with all faces around it.
struct SurfacePlace {
  /// What a point lies on.
  enum class On : std::uint8_t { kFace, kEdge, kCorner };

  std::int32_t triangle = -1;  ///< One of those that hold the point.
  On on = On::kFace;           ///< Which it is.
  std::uint8_t k = 0;  ///< Number of the edge or corner in it; edge k runs from corner k to k + 1.
};

}  // namespace thimble::render
