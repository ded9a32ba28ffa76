#include "view/ground_shadow.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "view/camera.h"

namespace thimble::view {
namespace {

const Eigen::Vector2i kSize(960, 640);
const LitPlace kPlace{.centre = {0.01, -0.02, 0.03}, .radius = 0.2, .ground_height = -0.05};
const Eigen::AlignedBox2f kCasters(Eigen::Vector2f(0.4F, 0.35F), Eigen::Vector2f(0.6F, 0.7F));

Camera camera_at(double yaw, double pitch, double distance) {
  Camera camera;
  camera.orbit(yaw, pitch);
  camera.distance = distance;
  return camera;
}

Eigen::AlignedBox2i box_of(const Camera& camera, const Eigen::AlignedBox2f& casters) {
  const ViewBlock block = view_block(camera, 1.5, Theme::kLight, kPlace, casters);
  return ground_shadow(block.view_projection, block.shadow_from_world, -0.05F, casters, kSize);
}

/// Counts the pixels of ground in the shadow, as the shader finds them (shader_parts.h, lit), and
/// those of them outside of the box.
struct Count {
  int shadowed = 0;
  int outside = 0;
};
Count count(const Camera& camera) {
  const ViewBlock block = view_block(camera, 1.5, Theme::kLight, kPlace, kCasters);
  const Eigen::AlignedBox2i box = box_of(camera, kCasters);
  Count result;
  for (int y = 0; y < kSize.y(); ++y) {
    for (int x = 0; x < kSize.x(); ++x) {
      const float u = 2 * (static_cast<float>(x) + 0.5F) / static_cast<float>(kSize.x()) - 1;
      const float v = 2 * (static_cast<float>(y) + 0.5F) / static_cast<float>(kSize.y()) - 1;
      const Eigen::Vector3f ray =
          (block.ray_ahead + u * block.ray_right + v * block.ray_up).head<3>();
      const float along = (-0.05F - block.eye.z()) / ray.z();
      if (!(along > 0)) continue;
      const Eigen::Vector3f p = block.eye.head<3>() + along * ray;
      const Eigen::Vector4f at = block.shadow_from_world * p.homogeneous();
      if (!kCasters.contains(Eigen::Vector2f(0.5F * at.head<2>().array() + 0.5F))) continue;
      ++result.shadowed;
      result.outside +=
          x < box.min().x() || x >= box.max().x() || y < box.min().y() || y >= box.max().y();
    }
  }
  return result;
}

TEST(GroundShadow, BoxContainsEveryShadowedGroundPixel) {
  for (const double yaw : {0.0, 0.7, 2.0, 3.9, 5.5}) {
    for (const double distance : {0.15, 0.3, 0.8}) {
      const Count all = count(camera_at(yaw, 0.1, distance));
      EXPECT_GT(all.shadowed, 500) << yaw << " " << distance;
      EXPECT_EQ(all.outside, 0) << yaw << " " << distance;
    }
  }
}

TEST(GroundShadow, IsASmallPartOfThePictureFromAfar) {
  const Camera camera = camera_at(0.7, 0.1, 0.8);
  const Eigen::AlignedBox2i box = box_of(camera, kCasters);
  EXPECT_LT(box.volume(), kSize.prod() / 4);
  EXPECT_LT(box.volume(), 4 * count(camera).shadowed);
}

TEST(GroundShadow, CoversAllIfTheGroundPassesTheEye) {
  EXPECT_TRUE(box_of(camera_at(0, 0, 0.3), {}).isEmpty());
  Camera within;  // among the objects that cast shadows, close to the ground
  within.distance = 0.001;
  const Eigen::AlignedBox2i box = box_of(within, kCasters);
  EXPECT_EQ(box.min(), Eigen::Vector2i::Zero());
  EXPECT_EQ(box.max(), kSize);
}

}  // namespace
}  // namespace thimble::view
