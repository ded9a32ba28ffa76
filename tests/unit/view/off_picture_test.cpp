#include "view/overlays/off_picture.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "support/random.h"
#include "unit/view/any_camera.h"

namespace thimble::view {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr double kWidth = 800, kHeight = 500, kMargin = 12;

bool is_in_picture(const Camera& camera, const Vector3d& p) {
  if (!((p - camera.p_WEye()).dot(camera.towards_eye()) < 0)) return false;
  const Vector2d at = camera.pixel(p, kWidth, kHeight);
  return at.x() >= 0 && at.x() <= kWidth && at.y() >= 0 && at.y() <= kHeight;
}

TEST(OffPicture, ArrowExistsExactlyForPointsOutside) {
  support::Random random(5);
  int outside = 0;
  for (int i = 0; i < 2000; ++i) {
    const Camera camera = any_camera(random, 0.1, 1);
    const Vector3d p = random.in_box(0.4);
    const bool arrow = arrow_to(camera, p, kWidth, kHeight, kMargin).has_value();
    EXPECT_EQ(arrow, !is_in_picture(camera, p));
    outside += arrow ? 1 : 0;
  }
  EXPECT_GT(outside, 200);
  EXPECT_LT(outside, 1900);
}

TEST(OffPicture, ArrowIsInThePictureAndPointsToThePoint) {
  support::Random random(6);
  for (int i = 0; i < 2000; ++i) {
    const Camera camera = any_camera(random, 0.1, 1);
    const Vector3d p = random.in_box(0.4);
    const auto arrow = arrow_to(camera, p, kWidth, kHeight, kMargin);
    if (!arrow) continue;
    EXPECT_NEAR(arrow->direction.norm(), 1, 1e-9);
    EXPECT_GE(arrow->at.x(), kMargin - 1e-6);
    EXPECT_LE(arrow->at.x(), kWidth - kMargin + 1e-6);
    EXPECT_GE(arrow->at.y(), kMargin - 1e-6);
    EXPECT_LE(arrow->at.y(), kHeight - kMargin + 1e-6);
    // A turn of the camera in this direction brings the point nearer to the axis of the view.
    const Vector3d from_eye = (p - camera.p_WEye()).normalized();
    const Vector3d way = arrow->direction.x() * camera.right() - arrow->direction.y() * camera.up();
    EXPECT_GT(way.dot(from_eye), 0);
  }
}

TEST(OffPicture, KeptPointIsInThePicture) {
  support::Random random(7);
  for (int i = 0; i < 2000; ++i) {
    Camera camera = any_camera(random, 0.1, 1);
    const Vector3d p = random.in_box(0.4);
    keep_in_picture(camera, p, kWidth / kHeight, 0.9);
    EXPECT_TRUE(is_in_picture(camera, p));
  }
}

TEST(OffPicture, CameraRestsWhileThePointIsInside) {
  Camera camera;
  const Vector3d before = camera.p_WTarget;
  keep_in_picture(camera, before + 0.02 * camera.right(), kWidth / kHeight, 0.9);
  EXPECT_EQ(camera.p_WTarget, before);
}

TEST(OffPicture, IgnoresNaN) {
  const Vector3d nowhere = Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  Camera camera;
  const Vector3d before = camera.p_WTarget;
  keep_in_picture(camera, nowhere, 1.6, 0.9);
  EXPECT_EQ(camera.p_WTarget, before);
  EXPECT_FALSE(arrow_to(camera, nowhere, kWidth, kHeight, kMargin));
}

}  // namespace
}  // namespace thimble::view
