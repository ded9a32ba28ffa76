#include "view/view_block.h"

#include <Eigen/Geometry>

namespace thimble::view {
namespace {

Eigen::Vector4f padded(const Eigen::Vector3f& v) {
  return {v.x(), v.y(), v.z(), 0};
}

Eigen::Vector3d towards_light() {
  return Eigen::Vector3d(0.45, -0.55, 1.0).normalized();
}

}  // namespace

Eigen::Vector3f linear(const Colour& colour) {
  return Eigen::Array3f(colour[0], colour[1], colour[2]).square();
}

Eigen::Matrix4f shadow_from_world(const LitPlace& place) {
  // The light is directional, along -z of its own frame, on a square about the scene.
  Eigen::Matrix4d shadow = Eigen::Matrix4d::Identity();
  const Eigen::Vector3d z = towards_light();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitZ().cross(z).normalized();
  shadow.block<1, 3>(0, 0) = x.transpose() / place.radius;
  shadow.block<1, 3>(1, 0) = z.cross(x).transpose() / place.radius;
  shadow.block<1, 3>(2, 0) = -z.transpose() / (2 * place.radius);
  shadow.block<3, 1>(0, 3) = -shadow.block<3, 3>(0, 0) * place.centre;
  return shadow.cast<float>();
}

void add_caster(const Eigen::Matrix4f& shadow_from_world, const Eigen::Matrix4f& model,
                const Eigen::AlignedBox3f& box, Eigen::AlignedBox2f& casters) {
  if (box.isEmpty()) return;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3f corner = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(k));
    const Eigen::Vector4f at = shadow_from_world * (model * corner.homogeneous());
    casters.extend(Eigen::Vector2f(0.5F * at.head<2>().array() + 0.5F));
  }
}

ViewBlock view_block(const Camera& camera, double aspect, Theme theme, const LitPlace& place,
                     const Eigen::AlignedBox2f& casters) {
  const ThemeColours colours = colours_of(theme);
  const Eigen::Matrix4f projection = camera.projection(aspect);
  ViewBlock block;
  block.view_projection = projection * camera.view();
  block.shadow_from_world = shadow_from_world(place);
  block.eye = padded(camera.p_WEye().cast<float>());
  block.key = padded(towards_light().cast<float>());
  block.sky = padded(linear(colours.sky));
  block.ground = padded(linear(colours.ground));
  block.grid = padded(linear(colours.grid));
  block.ground_place =
      Eigen::Vector4d(place.centre.x(), place.centre.y(), place.ground_height, 5 * place.radius)
          .cast<float>();
  block.ray_right = padded(camera.right().cast<float>() / projection(0, 0));
  block.ray_up = padded(camera.up().cast<float>() / projection(1, 1));
  block.ray_ahead = padded(-camera.towards_eye().cast<float>());
  block.from_depth = {projection(2, 3), projection(2, 2), 0, 0};
  block.casters = {casters.min().x(), casters.min().y(), casters.max().x(), casters.max().y()};
  return block;
}

}  // namespace thimble::view
