#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "view/camera.h"
#include "view/gl/palette.h"

namespace thimble::view {

/// The block `View` of the shaders, which all programs read; std140 adds no padding between these
/// members.
struct ViewBlock {
  Eigen::Matrix4f view_projection, shadow_from_world;
  Eigen::Vector4f eye, key, sky, ground, grid, ground_place;
  Eigen::Vector4f ray_right, ray_up, ray_ahead, from_depth, casters;
};

/// The part of a scene that is lit.
struct LitPlace {
  Eigen::Vector3d centre{0, 0, 0};  ///< m, W.
  double radius = 0.2;              ///< m: objects closer to the centre cast shadows.
  double ground_height = 0;         ///< m
};

/// Returns the transform from the world to the light's view, -1 to 1 along all sides.
Eigen::Matrix4f shadow_from_world(const LitPlace& place);

/// Extends a rectangle of the light's map, 0 to 1 along both sides, by a box that casts shadows.
void add_caster(const Eigen::Matrix4f& shadow_from_world, const Eigen::Matrix4f& model,
                const Eigen::AlignedBox3f& box, Eigen::AlignedBox2f& casters);

/// Converts a screen colour (sRGB) to linear light; the shaders convert it back.
Eigen::Vector3f linear(const Colour& colour);

/// Returns the block of one picture; `aspect` is width by height.
/// `casters`: box of the shadow casters in the light's map.
ViewBlock view_block(const Camera& camera, double aspect, Theme theme, const LitPlace& place,
                     const Eigen::AlignedBox2f& casters);

}  // namespace thimble::view
