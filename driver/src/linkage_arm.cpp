#include "thimble/driver/linkage_arm.h"

#include <cmath>

#include "cross_product.h"
#include "link_rotation.h"
#include "math/elementary.h"

namespace thimble::driver {
namespace {

/// Returns the angle at the base of a triangle, between `base` and `side`, whose third side is
/// `across` (m); NaN if there is no such triangle.
double angle_between(double base, double side, double across) noexcept {
  return math::acos((base * base + side * side - across * across) / (2 * base * side));
}

}  // namespace

void LinkageArm::forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
                         Eigen::Matrix3d& J_BT) const noexcept {
  const auto [sin_1, cos_1] = math::sin_cos(q[1]);
  const auto [sin_2, cos_2] = math::sin_cos(q[2]);
  // Vector from the crank's end to the elbow, and its derivatives by q1 and q2.
  const Eigen::Vector2d D(length_0 + length_1 * cos_1 - length_2 * cos_2,
                          length_1 * sin_1 - length_2 * sin_2);
  const Eigen::Vector2d D_by_1(-length_1 * sin_1, length_1 * cos_1);
  const Eigen::Vector2d D_by_2(length_2 * sin_2, -length_2 * cos_2);
  // Bar 3 closes when |D - length_4 u| = length_3, u along the forearm: D.u = along.
  const double along =
      (D.squaredNorm() + length_4 * length_4 - length_3 * length_3) / (2 * length_4);
  // acos of more than one is NaN, and so are all later results.
  const double lambda = math::atan2(D.y(), D.x()) - math::acos(along / D.norm());
  const auto [sin_lambda, cos_lambda] = math::sin_cos(lambda);
  const Eigen::Vector2d u(cos_lambda, sin_lambda);
  const Eigen::Vector2d across(-u.y(), u.x());
  const Eigen::Vector2d lambda_by_D = (D / length_4 - u) / D.dot(across);
  const Eigen::Vector2d lambda_by(lambda_by_D.dot(D_by_1), lambda_by_D.dot(D_by_2));

  const double r = length_0 / 2 + length_1 * cos_1 + length_5 * u.x();
  const double r_by_1 = -length_1 * sin_1 + length_5 * across.x() * lambda_by[0];
  const double r_by_2 = length_5 * across.x() * lambda_by[1];
  const double h_by_1 = length_1 * cos_1 + length_5 * across.y() * lambda_by[0];
  const double h_by_2 = length_5 * across.y() * lambda_by[1];
  const auto [sin_0, cos_0] = math::sin_cos(q[0]);
  p_BT = {r * cos_0, r * sin_0, length_1 * sin_1 + length_5 * u.y()};
  // clang-format off
  J_BT << -r * sin_0, r_by_1 * cos_0, r_by_2 * cos_0,
           r * cos_0, r_by_1 * sin_0, r_by_2 * sin_0,
                   0, h_by_1,         h_by_2;
  // clang-format on
}

Eigen::Matrix3d LinkageArm::last_link(const Eigen::Vector3d& q,
                                      const Eigen::Vector3d& p_BT) const noexcept {
  const auto [sin_0, cos_0] = math::sin_cos(q[0]);
  const double r = p_BT.x() * cos_0 + p_BT.y() * sin_0;
  const auto [sin_1, cos_1] = math::sin_cos(q[1]);
  const double out = r - length_0 / 2 - length_1 * cos_1;
  const double up = p_BT.z() - length_1 * sin_1;
  return link_rotation(cos_0, sin_0, out / length_5, up / length_5);
}

std::optional<Eigen::Vector3d> LinkageArm::inverse(const Eigen::Vector3d& p_BT) const noexcept {
  // In the arm's plane, with the front motor at the origin.
  const double r = math::hypot(p_BT.x(), p_BT.y());
  const Eigen::Vector2d tip(r - length_0 / 2, p_BT.z());
  const double q1 = math::atan2(tip.y(), tip.x()) + angle_between(tip.norm(), length_1, length_5);
  const Eigen::Vector2d elbow = length_1 * Eigen::Vector2d(math::cos(q1), math::sin(q1));
  const Eigen::Vector2d u = (tip - elbow) / length_5;
  // From the back motor to the joint of bar 3 with the other end of the forearm.
  const Eigen::Vector2d joint = elbow - length_4 * u + Eigen::Vector2d(length_0, 0);
  const double middle = math::atan2(joint.y(), joint.x());
  const double aside = angle_between(joint.norm(), length_2, length_3);
  for (const double q2 : {middle + aside, middle - aside}) {
    // `forward` turns clockwise from the crank's end to the forearm; so must this solution.
    const Eigen::Vector2d bar_3 = joint - length_2 * Eigen::Vector2d(math::cos(q2), math::sin(q2));
    if (!(cross(u, bar_3) > 0)) continue;
    return Eigen::Vector3d(math::atan2(p_BT.y(), p_BT.x()), q1, q2);
  }
  return std::nullopt;
}

}  // namespace thimble::driver
