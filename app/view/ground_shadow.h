#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "view/view_block.h"

namespace thimble::view {

/// Returns the part of a picture outside of which the ground lies in no shadow: pixels from the
/// lower left of the scene's part (`size`, pixels), whole ones. It is empty where nothing casts
/// shadows, and all of the picture where the ground below them goes behind the eye.
/// `casters`: of the light's map, 0 to 1, all that casts shadows and what a soft rim reaches.
Eigen::AlignedBox2i ground_shadow(const Eigen::Matrix4f& view_projection,
                                  const Eigen::Matrix4f& shadow_from_world, float ground_height,
                                  const Eigen::AlignedBox2f& casters, const Eigen::Vector2i& size);

}  // namespace thimble::view
