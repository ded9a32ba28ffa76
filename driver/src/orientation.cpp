#include "thimble/driver/orientation.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "math/elementary.h"

namespace thimble::driver {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;

}  // namespace

Eigen::Matrix3d rotation_about(FrameAxis axis, double angle) noexcept {
  const auto a = static_cast<Eigen::Index>(axis);
  const Eigen::Index b = (a + 1) % 3, c = (a + 2) % 3;
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  const auto [sine, cosine] = math::sin_cos(angle);
  R(b, b) = R(c, c) = cosine;
  R(c, b) = sine;
  R(b, c) = -R(c, b);
  return R;
}

TipQuaternion quaternion_of(const Eigen::Matrix3d& R) noexcept {
  const Eigen::Quaterniond q(R);
  const double length = q.norm();
  // Written so that NaN is rejected.
  if (!(length > 0 && length < HUGE_VAL)) return {};
  const double scale = (q.w() < 0 ? -1 : 1) / length;
  return {static_cast<float>(scale * q.w()), static_cast<float>(scale * q.x()),
          static_cast<float>(scale * q.y()), static_cast<float>(scale * q.z())};
}

Eigen::Matrix3d rotation_of(const TipQuaternion& q) noexcept {
  const Eigen::Quaterniond wide(q[0], q[1], q[2], q[3]);
  const double length = wide.norm();
  if (!(length > 0 && length < HUGE_VAL)) return Eigen::Matrix3d::Identity();
  return Eigen::Quaterniond(wide.coeffs() / length).toRotationMatrix();
}

Eigen::Vector3d Gimbal::angles(const std::array<std::int32_t, 3>& counters) const noexcept {
  Eigen::Vector3d angles;
  for (std::size_t i = 0; i < 3; ++i) {
    const double counts = static_cast<double>(counters[i]) + home_counts[i];
    angles[static_cast<Eigen::Index>(i)] = sign[i] * counts * kTurn / counts_per_turn[i];
  }
  return angles;
}

Eigen::Vector3d Gimbal::exact_counts(const Eigen::Vector3d& angles) const noexcept {
  Eigen::Vector3d counts;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    counts[k] = sign[i] * angles[k] * counts_per_turn[i] / kTurn - home_counts[i];
  }
  return counts;
}

Eigen::Matrix3d Gimbal::rotation(const Eigen::Vector3d& angles) const noexcept {
  return rotation_about(axes[0], angles[0]) * rotation_about(axes[1], angles[1]) *
         rotation_about(axes[2], angles[2]);
}

}  // namespace thimble::driver
