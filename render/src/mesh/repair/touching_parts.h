#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <string>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// How near triangles of two parts lie that count as touching, as a share of the diagonal of the
/// mesh's box: what rounding to single precision leaves of faces that are flush.
inline constexpr double kFlushTolerance = 1e-6;

/// The parts of a mesh that overlap or touch each other: where they overlap, contact finds a
/// cavity, and at their seam a tip may catch or lose contact.
struct TouchingParts {
  std::size_t pairs = 0;                          ///< How many pairs of parts touch.
  std::array<std::int32_t, 2> triangles{-1, -1};  ///< Of the first pair, one of each part.
  Eigen::Vector3d place{0, 0, 0};                 ///< Where they touch, a corner of the first.
  bool complete = true;                           ///< False if the search was cut off by its bound.
};

/// Finds the parts of a mesh that cross or touch other parts; parts share no vertex. Parts that lie
/// wholly within others, and away from their surface, do not touch them. Total; triangles that name
/// no three finite vertices are left out. O(n) where no boxes of parts meet, else O(n log n) and
/// the pairs of triangles whose boxes meet, up to a bound of about a second. Real-time: never from
/// the servo thread.
THIMBLE_EXPORT TouchingParts find_touching_parts(const TriangleMesh& mesh);

/// Returns the finding as a sentence for the user; empty if no parts touch.
THIMBLE_EXPORT std::string describe(const TouchingParts& parts);

}  // namespace thimble::render
