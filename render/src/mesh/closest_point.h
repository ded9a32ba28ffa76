#pragma once

#include <Eigen/Core>

#include "thimble/driver/export.h"

namespace thimble::render {

/// Finds the point of the triangle a, b, c closest to `p`; all in one frame, m, finite. If a corner
/// is closest, the result is bit-identical to that corner. For a triangle without area it is one of
/// its points, not always the closest. Real-time: safe.
THIMBLE_EXPORT Eigen::Vector3d closest_point(const Eigen::Vector3d& p, const Eigen::Vector3d& a,
                                             const Eigen::Vector3d& b,
                                             const Eigen::Vector3d& c) noexcept;

}  // namespace thimble::render
