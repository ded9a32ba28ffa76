#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Distance at which triangles of two parts count as touching, as a share of the diagonal of the
/// mesh's box: the error of flush faces after rounding to single precision.
inline constexpr double kFlushTolerance = 1e-6;

/// The parts of a mesh that overlap or touch each other. The tip feels their union
/// (overlapping_parts.h), unless the object dents or changes shape: then contact finds a cavity
/// where they overlap.
struct TouchingParts {
  std::size_t pairs = 0;                          ///< Number of pairs of parts that touch.
  std::array<std::int32_t, 2> triangles{-1, -1};  ///< Triangles of the first pair, one per part.
  Eigen::Vector3d place{0, 0, 0};                 ///< A point that both triangles have.
  bool complete = true;                           ///< False if the search reached its bound.
};

/// Finds the parts of a mesh that cross or touch other parts; parts share no vertex. Parts wholly
/// within others, and away from their surface, do not touch them. Total; triangles that do not name
/// three finite vertices are omitted. O(n) if no boxes of parts meet, else O(n log n) plus the
/// pairs of triangles whose boxes meet, up to a bound of about a second. Real-time: never from the
/// servo thread.
THIMBLE_EXPORT TouchingParts find_touching_parts(const TriangleMesh& mesh);

/// Returns the finding as a sentence for the user; empty if no parts touch.
THIMBLE_EXPORT std::string describe(const TouchingParts& parts);

}  // namespace thimble::render
