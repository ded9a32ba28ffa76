#include "thimble/driver/orientation.h"

#include <Eigen/Geometry>
#include <cmath>

namespace thimble::driver {

TipQuaternion quaternion_of(const Eigen::Matrix3d& R) noexcept {
  const Eigen::Quaterniond q(R);
  const double length = q.norm();
  // Written so that NaN is none.
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

}  // namespace thimble::driver
