#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "view/view_block.h"

namespace thimble::view {

/// Returns a box of the picture that contains all shadows on the ground: whole pixels from the
/// lower left of the scene's part (`size`, pixels). It is empty if nothing casts shadows, and the
/// whole picture if the ground below the casters extends behind the eye.
/// `casters`: box of all that casts shadows in the light's map, 0 to 1, including the width of soft
/// shadow edges.
Eigen::AlignedBox2i ground_shadow(const Eigen::Matrix4f& view_projection,
                                  const Eigen::Matrix4f& shadow_from_world, float ground_height,
                                  const Eigen::AlignedBox2f& casters, const Eigen::Vector2i& size);

}  // namespace thimble::view
