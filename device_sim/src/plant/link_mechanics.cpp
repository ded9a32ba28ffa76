#include "plant/link_mechanics.h"

#include <algorithm>
#include <cmath>

#include "math/elementary.h"

namespace thimble::device_sim {
namespace {

/// The min. inertia about the yaw axis over all sines of B and C: on an edge of their square, or in
/// its middle.
double min_inertia_about_yaw(const LinkSettings& links) {
  const auto about = [&](double x, double y) {
    return links.inertia[0] + links.yaw_b * x * x + links.yaw_c * y * y +
           2 * links.coupling * x * y;
  };
  double least = std::min({about(0, 0), about(1, 1), about(1, -1)});
  const double y = -links.coupling / links.yaw_c, x = -links.coupling / links.yaw_b;
  if (links.yaw_c > 0 && std::abs(y) < 1) least = std::min(least, about(1, y));
  if (links.yaw_b > 0 && std::abs(x) < 1) least = std::min(least, about(x, 1));
  return least;
}

}  // namespace

driver::Result<void> check_links(const LinkSettings& links) {
  const bool finite = links.inertia.allFinite() && links.gravity_B.allFinite() &&
                      std::isfinite(links.yaw_b) && std::isfinite(links.yaw_c) &&
                      std::isfinite(links.coupling) && std::isfinite(links.moment_b) &&
                      std::isfinite(links.moment_c);
  if (!finite) return driver::Error{"The simulated arm's links must have finite constants."};
  // Rounding of constants that are written with six digits.
  constexpr double kRounding = 1e-5;
  const double square = links.coupling * links.coupling;
  if (!((links.inertia.array() >= 0).all() &&
        square <= (1 + kRounding) * links.inertia[1] * links.inertia[2])) {
    return driver::Error{
        "The simulated arm's links are physically impossible: inertia must not be negative, and "
        "the square of coupling must be at most inertia B times inertia C."};
  }
  const double most = links.inertia[0] + std::abs(links.yaw_b) + std::abs(links.yaw_c);
  if (!(min_inertia_about_yaw(links) >= -kRounding * most)) {
    return driver::Error{
        "The simulated arm's links are physically impossible: with these yaw_b, yaw_c and coupling "
        "the inertia about the yaw axis is negative in some pose."};
  }
  return {};
}

LinkMotion LinkMechanics::at(const Eigen::Vector3d& q, const Eigen::Vector3d& rate) const noexcept {
  const auto [sin_a, cos_a] = math::sin_cos(q[0]);
  const auto [sin_b, cos_b] = math::sin_cos(q[1]);
  const auto [sin_c, cos_c] = math::sin_cos(q[2]);
  const double a = rate[0], b = rate[1], c = rate[2];
  const double cos_sum = cos_b * cos_c - sin_b * sin_c, sin_sum = sin_b * cos_c + cos_b * sin_c;
  const double K = links_.coupling;
  LinkMotion found;
  Eigen::Matrix3d& M = found.inertia;
  M(0, 0) = links_.inertia[0] + links_.yaw_b * sin_b * sin_b + links_.yaw_c * sin_c * sin_c +
            2 * K * sin_b * sin_c;
  M(1, 1) = links_.inertia[1];
  M(2, 2) = links_.inertia[2];
  M(1, 2) = M(2, 1) = K * cos_sum;
  // Half of the derivatives of M_AA by B and C.
  const double by_b = (links_.yaw_b * sin_b + K * sin_c) * cos_b;
  const double by_c = (links_.yaw_c * sin_c + K * sin_b) * cos_c;
  // The first moments act like a tip with the lengths moment_b and moment_c.
  const driver::SerialArm moments{
      .height = 0, .length_b = links_.moment_b, .length_c = links_.moment_c};
  found.torque = moments.jacobian(q).transpose() * links_.gravity_B -
                 Eigen::Vector3d(2 * a * (by_b * b + by_c * c), -K * sin_sum * c * c - by_b * a * a,
                                 -K * sin_sum * b * b - by_c * a * a);
  const double lb = arm_.length_b, lc = arm_.length_c;
  const double r = lb * sin_b + lc * sin_c, r_rate = lb * cos_b * b + lc * cos_c * c;
  const double outward = -lb * sin_b * b * b - lc * sin_c * c * c - r * a * a;
  const double along = 2 * r_rate * a;
  found.turning = {outward * cos_a - along * sin_a, outward * sin_a + along * cos_a,
                   -lb * cos_b * b * b + lc * cos_c * c * c};
  return found;
}

}  // namespace thimble::device_sim
