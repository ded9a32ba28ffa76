#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "packed/compact_surface.h"
#include "packed/lowered_place.h"
#include "packed/lowered_triangle.h"

// Where lowered triangles alone do not say where the tip belongs: at creases and in gaps.

namespace thimble::render {

/// Tells how far `p` (steps) is on this side of the plane that halves the angle at a crease, as a
/// share of the triangle's height over that edge. Real-time: safe.
double side_of_crease(const Eigen::Vector3d& p, const CompactTriangle& own, std::size_t edge,
                      const CompactTriangle& other) noexcept;

/// Tells what is felt at the point of a record that is nearest to `p` (steps), where no lowered
/// triangle holds it; `lowered` is that record unpacked. Real-time: safe.
LoweredFeel feel_nearest(const Eigen::Vector3d& p, const CompactTriangle& record,
                         const LoweredTriangle& lowered) noexcept;

}  // namespace thimble::render
