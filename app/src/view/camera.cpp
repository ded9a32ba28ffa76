#include "view/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace thimble::app::view {
namespace {

constexpr double kSteepest = 1.5;  // rad: short of straight up and down, where "up" is not known

// How the eye stands if nothing else asks for more: a little to the user's right and above, like
// someone who looks over the user's shoulder.
constexpr double kYaw = 0.55;
constexpr double kPitch = 0.42;
constexpr double kMargin = 1.12;  // of the box, so that nothing stands at the picture's rim

}  // namespace

Eigen::Vector3d placed(const render::BodyPose& pose, const Eigen::Vector3d& p_B) {
  const Eigen::Quaterniond q_WB(pose.q_WB[0], pose.q_WB[1], pose.q_WB[2], pose.q_WB[3]);
  return Eigen::Map<const Eigen::Vector3d>(pose.p_WB.data()) + q_WB * p_B;
}

Eigen::Vector3d Camera::towards_eye() const {
  return {std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch)};
}

Eigen::Vector3d Camera::right() const { return {-std::sin(yaw), std::cos(yaw), 0}; }

Eigen::Vector3d Camera::up() const { return towards_eye().cross(right()); }

Eigen::Matrix4f Camera::view() const {
  Eigen::Matrix4d view = Eigen::Matrix4d::Identity();
  view.block<1, 3>(0, 0) = right().transpose();
  view.block<1, 3>(1, 0) = up().transpose();
  view.block<1, 3>(2, 0) = towards_eye().transpose();
  view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * p_WEye();
  return view.cast<float>();
}

Eigen::Matrix4f Camera::projection(double aspect) const {
  const double nearest = 0.05 * distance;
  const double farthest = distance + 3;  // m: beyond any arm
  const double focal = 1 / std::tan(opening / 2);
  Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
  projection(0, 0) = focal / aspect;
  projection(1, 1) = focal;
  projection(2, 2) = -(farthest + nearest) / (farthest - nearest);
  projection(2, 3) = -2 * farthest * nearest / (farthest - nearest);
  projection(3, 2) = -1;
  return projection.cast<float>();
}

Eigen::Vector2d Camera::pixel(const Eigen::Vector3d& p_W, double width, double height) const {
  const Eigen::Vector3d from_eye = p_W - p_WEye();
  const double scale = height / 2 / std::tan(opening / 2) / -from_eye.dot(towards_eye());
  return {width / 2 + scale * from_eye.dot(right()), height / 2 - scale * from_eye.dot(up())};
}

Eigen::Vector3d Camera::ray(double x, double y, double width, double height) const {
  const double scale = std::tan(opening / 2) / (height / 2);
  return ((x - width / 2) * scale * right() - (y - height / 2) * scale * up() - towards_eye())
      .normalized();
}

void Camera::orbit(double by_yaw, double by_pitch) {
  yaw = std::remainder(yaw + by_yaw, 2 * std::numbers::pi);
  pitch = std::clamp(pitch + by_pitch, -kSteepest, kSteepest);
}

void Camera::pan(double right_share, double up_share) {
  const double height = 2 * distance * std::tan(opening / 2);
  p_WTarget -= height * (right_share * right() + up_share * up());
}

void Camera::zoom(double factor) { distance = std::clamp(distance / factor, 1e-3, 10.0); }

Eigen::AlignedBox3d framed_box(const DrawnScene& scene, const DrawnMoment& moment) {
  Eigen::AlignedBox3d box;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].endless) continue;
    const render::BodyPose pose =
        i < moment.poses.size() ? moment.poses[i] : render::BodyPose{};
    for (const Eigen::Vector3d& vertex : scene.objects[i].mesh.vertices) {
      box.extend(placed(pose, vertex));
    }
  }
  const Eigen::Map<const Eigen::Vector3d> p_WT(moment.tick.p_WT.data());
  if (p_WT.allFinite()) box.extend(p_WT);
  // A field has no size: the tip alone would fill the picture.
  const double least = 0.06;  // m
  if (box.sizes().maxCoeff() < least) {
    box.extend(Eigen::Vector3d(box.center().array() + least / 2));
    box.extend(Eigen::Vector3d(box.center().array() - least / 2));
  }
  return box;
}

Camera frame(const DrawnScene& scene, const DrawnMoment& moment, double aspect) {
  Camera camera;
  camera.yaw = kYaw;
  camera.pitch = kPitch;
  // A touch that would be hidden is turned to the front, part of the way.
  const Eigen::Map<const Eigen::Vector3d> n_W(moment.tick.n_W.data());
  if (moment.tick.in_contact && n_W.head<2>().norm() > 0.35) {
    const double away = std::remainder(std::atan2(n_W.y(), n_W.x()) - kYaw, 2 * std::numbers::pi);
    camera.yaw = kYaw + std::clamp(away, -1.9, 1.9) * 0.6;
  }
  if (moment.tick.in_contact && n_W.z() > 0.9) camera.pitch = 0.5;

  const Eigen::AlignedBox3d box = framed_box(scene, moment);
  camera.p_WTarget = box.center();
  const double slope_v = std::tan(camera.opening / 2) / kMargin;
  const double slope_u = slope_v * aspect;
  // The least distance at which each corner of the box is inside all four sides of the picture.
  double distance = 0;
  for (int k = 0; k < 8; ++k) {
    const Eigen::Vector3d corner =
        box.corner(static_cast<Eigen::AlignedBox3d::CornerType>(k)) - box.center();
    const double towards = corner.dot(camera.towards_eye());
    distance = std::max({distance, towards + std::abs(corner.dot(camera.right())) / slope_u,
                         towards + std::abs(corner.dot(camera.up())) / slope_v});
  }
  camera.distance = distance;
  return camera;
}

}  // namespace thimble::app::view
