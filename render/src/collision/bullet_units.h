#pragma once

#include <LinearMath/btTransform.h>

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace thimble::render {

/// Converts between the vectors of Eigen and of Bullet. Real-time: safe.
inline btVector3 to_bullet(const Eigen::Vector3d& v) noexcept {
  return {v.x(), v.y(), v.z()};
}
inline Eigen::Vector3d from_bullet(const btVector3& v) noexcept {
  return {v.x(), v.y(), v.z()};
}
inline btQuaternion to_bullet(const Eigen::Quaterniond& q) noexcept {
  return {q.x(), q.y(), q.z(), q.w()};
}
inline Eigen::Quaterniond from_bullet(const btQuaternion& q) noexcept {
  return {q.w(), q.x(), q.y(), q.z()};
}
inline btMatrix3x3 to_bullet(const Eigen::Matrix3d& R) noexcept {
  return {R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)};
}
inline btTransform transform_of(const Eigen::Matrix3d& R, const Eigen::Vector3d& p) noexcept {
  return btTransform(to_bullet(R), to_bullet(p));
}

}  // namespace thimble::render
