#include "view/camera.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "view/touch_marks.h"

namespace thimble::view {
namespace {

constexpr double kSteepest = 1.5;  // rad: just below vertical, where "up" is undefined

// Default direction: a little to the user's right and above, like someone who looks over the user's
// shoulder.
constexpr double kYaw = 0.55;
constexpr double kPitch = 0.42;
constexpr double kMargin = 1.12;  // margin around the box at the picture's border

/// Adds an arm's tip and the end of its force arrow.
void add_touch(const DrawnScene& scene, const driver::TickRecord& tick,
               std::vector<Eigen::Vector3d>& points) {
  const Eigen::Map<const Eigen::Vector3d> p_WT(tick.p_WT.data());
  const Eigen::Map<const Eigen::Vector3d> f_W(tick.f_sent_W.data());
  if (p_WT.allFinite()) points.emplace_back(p_WT);
  if (p_WT.allFinite() && f_W.norm() > 0) {
    const Eigen::Map<const Eigen::Vector3d> p_WP(tick.p_WP.data());
    const Eigen::Vector3d from = tick.in_contact && p_WP.allFinite() ? p_WP : p_WT;
    points.emplace_back(from + arrow_length(f_W.norm(), scene) * f_W.normalized());
  }
}

/// Returns the yaw from which the two tips of a scene with several arms that are farthest apart are
/// next to each other; none if one is above the other, or if there is one arm.
std::optional<double> yaw_across_tips(const DrawnMoment& moment) {
  constexpr double kMin = 0.02;   // m: closer tips are seen from any side. [chosen]
  constexpr double kLean = 0.35;  // rad towards the default direction: depth is seen. [chosen]
  std::vector<Eigen::Vector2d> tips{{moment.tick.p_WT[0], moment.tick.p_WT[1]}};
  for (const DrawnArm& other : moment.others) {
    tips.emplace_back(other.tick.p_WT[0], other.tick.p_WT[1]);
  }
  Eigen::Vector2d line(0, 0);
  for (const Eigen::Vector2d& a : tips) {
    for (const Eigen::Vector2d& b : tips) {
      if ((b - a).norm() > line.norm()) line = b - a;  // never for NaN
    }
  }
  if (!(line.norm() > kMin)) return {};
  double across = std::atan2(line.x(), -line.y());
  // Of the two sides, the one nearer to the default direction.
  if (std::cos(across - kYaw) < 0) across += std::numbers::pi;
  const double lean = std::remainder(kYaw - across, 2 * std::numbers::pi);
  return across + std::clamp(lean, -kLean, kLean);
}

}  // namespace

Eigen::Vector3d placed(const render::BodyPose& pose, const Eigen::Vector3d& p_B) {
  const Eigen::Quaterniond q_WB(pose.q_WB[0], pose.q_WB[1], pose.q_WB[2], pose.q_WB[3]);
  return Eigen::Map<const Eigen::Vector3d>(pose.p_WB.data()) + q_WB * p_B;
}

Eigen::Vector3d Camera::towards_eye() const {
  return {std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw), std::sin(pitch)};
}

Eigen::Vector3d Camera::right() const {
  return {-std::sin(yaw), std::cos(yaw), 0};
}

Eigen::Vector3d Camera::up() const {
  return towards_eye().cross(right());
}

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

void Camera::zoom(double factor) {
  distance = std::clamp(distance / factor, 1e-3, 10.0);
}

std::vector<Eigen::Vector3d> framed_points(const DrawnScene& scene, const DrawnMoment& moment) {
  constexpr std::size_t kEnough = 4000;  // vertices are enough to frame a mesh
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < scene.objects.size(); ++i) {
    if (scene.objects[i].endless) continue;
    const render::BodyPose pose = i < moment.poses.size() ? moment.poses[i] : render::BodyPose{};
    const auto& vertices = scene.objects[i].mesh.vertices;
    const std::size_t step = vertices.size() / kEnough + 1;
    for (std::size_t v = 0; v < vertices.size(); v += step) {
      points.push_back(placed(pose, vertices[v]));
    }
  }
  add_touch(scene, moment.tick, points);
  for (const DrawnArm& other : moment.others) add_touch(scene, other.tick, points);
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  // Minimum size of the framed box: a field has no size, so the tip would fill the picture.
  constexpr double kMin = 0.1;  // m
  if (box.isEmpty()) box.extend(Eigen::Vector3d(0, 0, 0));
  if (box.sizes().maxCoeff() < kMin) {
    for (const double end : {-kMin / 2, kMin / 2}) {
      for (int k = 0; k < 3; ++k) {
        points.emplace_back(box.center() + end * Eigen::Vector3d::Unit(k));
      }
    }
  }
  return points;
}

Camera frame(const DrawnScene& scene, const DrawnMoment& moment, double aspect) {
  Camera camera;
  camera.yaw = kYaw;
  camera.pitch = kPitch;
  // Turns the camera part of the way towards a touch that would be hidden.
  const Eigen::Map<const Eigen::Vector3d> n_W(moment.tick.n_W.data());
  if (const auto across = yaw_across_tips(moment)) {
    camera.yaw = *across;
  } else if (moment.tick.in_contact && n_W.head<2>().norm() > 0.35) {
    const double away = std::remainder(std::atan2(n_W.y(), n_W.x()) - kYaw, 2 * std::numbers::pi);
    camera.yaw = kYaw + std::clamp(away, -1.9, 1.9) * 0.6;
  }
  if (moment.tick.in_contact && n_W.z() > 0.9) camera.pitch = 0.5;

  const std::vector<Eigen::Vector3d> points = framed_points(scene, moment);
  const double slope_v = std::tan(camera.opening / 2) / kMargin;
  const double slope_u = slope_v * aspect;
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3d& point : points) box.extend(point);
  camera.p_WTarget = box.center();
  // Finds the smallest distance at which each point is inside all four sides of the picture. Then
  // repeats it with the target moved to the middle of the visible points.
  for (int round = 0; round < 4; ++round) {
    const Eigen::Vector3d forward = camera.towards_eye();
    camera.distance = 0.02;
    Eigen::Array2d low(1e9, 1e9);
    Eigen::Array2d high(-1e9, -1e9);
    for (const Eigen::Vector3d& point : points) {
      const Eigen::Vector3d from = point - camera.p_WTarget;
      const double towards = from.dot(forward);
      const Eigen::Array2d seen(from.dot(camera.right()), from.dot(camera.up()));
      camera.distance = std::max({camera.distance, towards + std::abs(seen.x()) / slope_u,
                                  towards + std::abs(seen.y()) / slope_v});
      low = low.min(seen);
      high = high.max(seen);
    }
    if (round == 3) break;
    const Eigen::Array2d middle = (low + high) / 2;
    camera.p_WTarget += middle.x() * camera.right() + middle.y() * camera.up();
  }
  return camera;
}

}  // namespace thimble::view
