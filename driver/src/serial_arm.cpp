#include "thimble/driver/serial_arm.h"

#include <cmath>

#include "link_rotation.h"
#include "math/elementary.h"

namespace thimble::driver {

void SerialArm::forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
                        Eigen::Matrix3d& J_BT) const noexcept {
  const auto [sin_a, cos_a] = math::sin_cos(q[0]);
  const auto [sin_b, cos_b] = math::sin_cos(q[1]);
  const auto [sin_c, cos_c] = math::sin_cos(q[2]);
  const double r = length_b * sin_b + length_c * sin_c;
  p_BT = {r * cos_a, r * sin_a, height + length_b * cos_b - length_c * cos_c};
  // clang-format off
  J_BT << -r * sin_a, length_b * cos_b * cos_a, length_c * cos_c * cos_a,
           r * cos_a, length_b * cos_b * sin_a, length_c * cos_c * sin_a,
                   0,        -length_b * sin_b,         length_c * sin_c;
  // clang-format on
}

Eigen::Vector3d SerialArm::forward(const Eigen::Vector3d& q) const noexcept {
  const auto [sin_a, cos_a] = math::sin_cos(q[0]);
  const auto [sin_b, cos_b] = math::sin_cos(q[1]);
  const auto [sin_c, cos_c] = math::sin_cos(q[2]);
  const double r = length_b * sin_b + length_c * sin_c;
  return {r * cos_a, r * sin_a, height + length_b * cos_b - length_c * cos_c};
}

Eigen::Matrix3d SerialArm::jacobian(const Eigen::Vector3d& q) const noexcept {
  Eigen::Vector3d p_BT;
  Eigen::Matrix3d J_BT;
  forward(q, p_BT, J_BT);
  return J_BT;
}

Eigen::Matrix3d SerialArm::last_link(const Eigen::Vector3d& q,
                                     const Eigen::Vector3d&) const noexcept {
  // Link C points C - 90 degrees above the horizontal.
  const auto [sin_a, cos_a] = math::sin_cos(q[0]);
  const auto [sin_c, cos_c] = math::sin_cos(q[2]);
  return link_rotation(cos_a, sin_a, sin_c, -cos_c);
}

std::optional<Eigen::Vector3d> SerialArm::inverse(const Eigen::Vector3d& p_BT) const noexcept {
  const double r = math::hypot(p_BT.x(), p_BT.y());
  const double z = p_BT.z() - height;
  const double distance_squared = r * r + z * z;
  // The law of cosines gives the angle between the links, B + C.
  const double cos_sum =
      (length_b * length_b + length_c * length_c - distance_squared) / (2 * length_b * length_c);
  if (!(r > 0) || !(std::abs(cos_sum) < 1)) return std::nullopt;
  const double sin_sum = std::sqrt((1 - cos_sum) * (1 + cos_sum));
  // r = u sin(B) + w cos(B) and z = u cos(B) - w sin(B), solved for B.
  const double u = length_b - length_c * cos_sum;
  const double w = length_c * sin_sum;
  const double b = math::atan2(u * r - w * z, w * r + u * z);
  return Eigen::Vector3d{math::atan2(p_BT.y(), p_BT.x()), b, math::atan2(sin_sum, cos_sum) - b};
}

}  // namespace thimble::driver
