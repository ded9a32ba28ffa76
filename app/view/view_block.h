#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "view/camera.h"
#include "view/gl/palette.h"

namespace thimble::view {

/// The block `View` of the shaders, which all programs read; std140 leaves no gaps between these.
struct ViewBlock {
  Eigen::Matrix4f view_projection, shadow_from_world;
  Eigen::Vector4f eye, key, sky, ground, grid, ground_place;
  Eigen::Vector4f ray_right, ray_up, ray_ahead, from_depth, casters;
};

/// What of a scene the light falls on.
struct LitPlace {
  Eigen::Vector3d centre{0, 0, 0};  ///< m, W.
  double radius = 0.2;              ///< m: what is nearer to the centre casts shadows.
  double ground_height = 0;         ///< m
};

/// Takes the world to what the light sees, -1 to 1 along all sides.
Eigen::Matrix4f shadow_from_world(const LitPlace& place);

/// Adds a box that casts shadows to a rectangle of the light's map, 0 to 1 along both sides.
void add_caster(const Eigen::Matrix4f& shadow_from_world, const Eigen::Matrix4f& model,
                const Eigen::AlignedBox3f& box, Eigen::AlignedBox2f& casters);

/// Turns a colour as on the screen into amounts of light, as the shaders turn it back.
Eigen::Vector3f linear(const Colour& colour);

/// Makes the block of one picture; `aspect` is width by height.
/// `casters`: what casts shadows, in the light's map.
ViewBlock view_block(const Camera& camera, double aspect, Theme theme, const LitPlace& place,
                     const Eigen::AlignedBox2f& casters);

}  // namespace thimble::view
