#pragma once

#include <Eigen/Core>

#include "thimble/driver/export.h"

namespace thimble::render {

/// Finds the point of the triangle a, b, c nearest to `p`; all in one frame, m, finite. Where a
/// corner is nearest the answer is that corner to the bit. A triangle without area gives one of its
/// points, not always the nearest. Real-time: safe.
THIMBLE_EXPORT Eigen::Vector3d closest_point(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                             const Eigen::Vector3d& b,
                                             const Eigen::Vector3d& c) noexcept;

}  // namespace thimble::render
