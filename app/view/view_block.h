#pragma once

#include <Eigen/Core>

#include "view/camera.h"
#include "view/gl/palette.h"

namespace thimble::app::view {

/// The block `View` of the shaders, which all programs read; std140 leaves no gaps between these.
struct ViewBlock {
  Eigen::Matrix4f view_projection, shadow_from_world;
  Eigen::Vector4f eye, key, sky, ground, grid, ground_place;
};

/// What of a scene the light falls on.
struct LitPlace {
  Eigen::Vector3d centre{0, 0, 0};  ///< m, W.
  double radius = 0.2;              ///< m: what is nearer to the centre casts shadows.
  double ground_height = 0;         ///< m
};

/// Turns a colour as on the screen into amounts of light, as the shaders turn it back.
Eigen::Vector3f linear(const Colour& colour);

/// Makes the block of one picture; `aspect` is width by height.
ViewBlock view_block(const Camera& camera, double aspect, Theme theme, const LitPlace& place);

}  // namespace thimble::app::view
