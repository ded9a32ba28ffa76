#include "plant/serial_pose.h"

#include <algorithm>
#include <cmath>

#include "math/elementary.h"

namespace thimble::device_sim {

SerialPose::SerialPose(const driver::SerialArm& arm, const Eigen::Vector3d& p_BT) noexcept
    : length_b_(arm.length_b), length_c_(arm.length_c) {
  const double lb = length_b_, lc = length_c_;
  r_ = std::sqrt(p_BT.x() * p_BT.x() + p_BT.y() * p_BT.y());
  const double z = p_BT.z() - arm.height;
  const double distance_squared = r_ * r_ + z * z;
  const double cos_sum = (lb * lb + lc * lc - distance_squared) / (2 * lb * lc);
  // A NaN fails both comparisons and is out of reach.
  within_reach_ = r_ > 0 && std::abs(cos_sum) < 1;
  if (!within_reach_) return;
  sin_sum_ = std::sqrt((1 - cos_sum) * (1 + cos_sum));
  const double over_r = 1 / r_;
  cos_a_ = p_BT.x() * over_r;
  sin_a_ = p_BT.y() * over_r;
  // r = u sin B + w cos B and z = u cos B - w sin B; u^2 + w^2 is the squared distance.
  const double u = lb - lc * cos_sum;
  const double w = lc * sin_sum_;
  const double over_square = 1 / distance_squared;
  sin_b_ = (u * r_ - w * z) * over_square;
  cos_b_ = (w * r_ + u * z) * over_square;
  // C = (B + C) - B.
  sin_c_ = sin_sum_ * cos_b_ - cos_sum * sin_b_;
  cos_c_ = cos_sum * cos_b_ + sin_sum_ * sin_b_;
}

Eigen::Vector3d SerialPose::force_from(const Eigen::Vector3d& tau) const noexcept {
  // J_BT has a tangential column of length r for the yaw, and the 2x2 block
  //   (lb cos B, lc cos C; -lb sin B, lc sin C), determinant lb lc sin(B + C),
  // in the plane of the links.
  const double tangential = tau[0] / std::max(r_, kSingular * length_b_);
  const double over_determinant = 1 / (length_b_ * length_c_ * std::max(sin_sum_, kSingular));
  const double over_b = tau[1] * length_c_ * over_determinant;
  const double over_c = tau[2] * length_b_ * over_determinant;
  const double radial = sin_c_ * over_b + sin_b_ * over_c;
  const double up = cos_b_ * over_c - cos_c_ * over_b;
  return {radial * cos_a_ - tangential * sin_a_, radial * sin_a_ + tangential * cos_a_, up};
}

Eigen::Vector3d SerialPose::angles() const noexcept {
  return {math::atan2(sin_a_, cos_a_), math::atan2(sin_b_, cos_b_), math::atan2(sin_c_, cos_c_)};
}

bool SerialPose::angles_near(const SerialPose& from, const Eigen::Vector3d& q_from,
                             Eigen::Vector3d& q) const noexcept {
  // Closer to that, sines and cosines are not those of unit vectors to a few roundings.
  if (!(sin_sum_ > kSingular)) return false;
  const Eigen::Vector3d sin_turned(sin_a_ * from.cos_a_ - cos_a_ * from.sin_a_,
                                   sin_b_ * from.cos_b_ - cos_b_ * from.sin_b_,
                                   sin_c_ * from.cos_c_ - cos_c_ * from.sin_c_);
  const double min_cos = std::min({cos_a_ * from.cos_a_ + sin_a_ * from.sin_a_,
                                   cos_b_ * from.cos_b_ + sin_b_ * from.sin_b_,
                                   cos_c_ * from.cos_c_ + sin_c_ * from.sin_c_});
  if (!(min_cos > 0)) return false;
  constexpr double kNear = 0.05;
  // Half a turn less the series' max. contribution: beyond, the arc tangent changes its sign.
  constexpr double kHalfTurn = 3.14;
  for (int i = 0; i < 3; ++i) {
    const double s = sin_turned[i], s2 = s * s;
    // The arc sine's series; the next term is below 0.031 s^9, 6e-14 at the bound.
    q[i] = q_from[i] + s * (1 + s2 * (1.0 / 6 + s2 * (3.0 / 40 + s2 * (15.0 / 336))));
    if (!(std::abs(s) < kNear && std::abs(q[i]) < kHalfTurn)) return false;
  }
  return true;
}

}  // namespace thimble::device_sim
