#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "thimble/driver/export.h"

namespace thimble::bag {

/// Axes of the vectors in a bag.
enum class BagAxes : std::uint8_t {
  kPlain,  ///< Axes of the world W: x towards the user, y to the user's right, z up.
  kOmni,   ///< Axes of the Omni's drivers: x to the right, y away from the user, z up.
};

/// Returns a vector of a bag in the world's axes. Real-time: safe.
THIMBLE_EXPORT Eigen::Vector3d in_world(BagAxes axes, const Eigen::Vector3d& v) noexcept;

}  // namespace thimble::bag
