#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "compact_mesh/offset_place.h"
#include "compact_mesh/offset_triangle.h"
#include "compact_mesh/packed_surface.h"

// The contact where offset triangles do not determine the place of the tip: at creases and in gaps.

namespace thimble::render {

/// Returns how far `p` (steps) is inside the plane that halves the angle at a crease, as a share of
/// the triangle's height over that edge. Real-time: safe.
double side_of_crease(const Eigen::Vector3d& p, const PackedTriangle& own, std::size_t edge,
                      const PackedTriangle& other) noexcept;

/// Returns the felt contact at the point of a packed triangle closest to `p` (steps), if no offset
/// triangle holds it; `offset` is that packed triangle unpacked. Real-time: safe.
OffsetResponse feel_nearest(const Eigen::Vector3d& p, const PackedTriangle& packed,
                            const OffsetTriangle& offset) noexcept;

}  // namespace thimble::render
