#include "view/view_block.h"

#include <Eigen/Geometry>

namespace thimble::app::view {
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

ViewBlock view_block(const Camera& camera, double aspect, Theme theme, const LitPlace& place) {
  // The light looks along -z of its own frame, straight, at a square about the scene.
  Eigen::Matrix4d shadow = Eigen::Matrix4d::Identity();
  const Eigen::Vector3d z = towards_light();
  const Eigen::Vector3d x = Eigen::Vector3d::UnitZ().cross(z).normalized();
  shadow.block<1, 3>(0, 0) = x.transpose() / place.radius;
  shadow.block<1, 3>(1, 0) = z.cross(x).transpose() / place.radius;
  shadow.block<1, 3>(2, 0) = -z.transpose() / (2 * place.radius);
  shadow.block<3, 1>(0, 3) = -shadow.block<3, 3>(0, 0) * place.centre;
  const ThemeColours colours = colours_of(theme);
  ViewBlock block;
  block.view_projection = camera.projection(aspect) * camera.view();
  block.shadow_from_world = shadow.cast<float>();
  block.eye = padded(camera.p_WEye().cast<float>());
  block.key = padded(z.cast<float>());
  block.sky = padded(linear(colours.sky));
  block.ground = padded(linear(colours.ground));
  block.grid = padded(linear(colours.grid));
  block.ground_place =
      Eigen::Vector4d(place.centre.x(), place.centre.y(), place.ground_height, 5 * place.radius)
          .cast<float>();
  return block;
}

}  // namespace thimble::app::view
