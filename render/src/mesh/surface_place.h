#pragma once

#include <cstdint>

namespace thimble::render {

/// The part of a surface on which a point is: the inside of a face, an edge with its two faces, or
/// a corner with all faces around it.
struct SurfacePlace {
  /// Kind of part.
  enum class On : std::uint8_t { kFace, kEdge, kCorner };

  std::int32_t triangle = -1;  ///< One of the triangles that contain the point.
  On on = On::kFace;           ///< Kind of part of that triangle.
  std::uint8_t k = 0;  ///< Number of the edge or corner in it; edge k is from corner k to k + 1.
};

}  // namespace thimble::render
