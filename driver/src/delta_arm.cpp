#include "thimble/driver/delta_arm.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

#include "math/elementary.h"

namespace thimble::driver {
namespace {

/// The end of one leg in the leg's own frame, m.
struct LegEnd {
  double u, v, w;
};

LegEnd leg_end(const DeltaArm& arm, std::size_t leg, const Eigen::Vector3d& p_BT) noexcept {
  const auto [sin_a, cos_a] = math::sin_cos(arm.azimuth[leg]);
  return {cos_a * p_BT.x() + sin_a * p_BT.y() - arm.r + arm.c,
          -sin_a * p_BT.x() + cos_a * p_BT.y() - arm.s + arm.f, p_BT.z()};
}

/// Closure error of each leg (m^2), and its derivatives by tip and leg angles.
struct Closure {
  Eigen::Vector3d error;
  Eigen::Matrix3d by_p;
  Eigen::Vector3d by_q;
};

Closure closure_at(const DeltaArm& arm, const Eigen::Vector3d& q,
                   const Eigen::Vector3d& p_BT) noexcept {
  Closure closure;
  const double offset = arm.d + arm.e;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const LegEnd end = leg_end(arm, i, p_BT);
    const auto [sin_q, cos_q] = math::sin_cos(q[k]);
    const double u = end.u - arm.a * cos_q;
    const double w = end.w - arm.a * sin_q;
    const double rho = math::hypot(u, w);
    const double reach = rho - offset;
    closure.error[k] = reach * reach + end.v * end.v - arm.b * arm.b;
    // d(reach^2) = 2 reach drho, drho = (u du + w dw) / rho
    const double by_u = 2 * reach * u / rho, by_w = 2 * reach * w / rho, by_v = 2 * end.v;
    const auto [sin_a, cos_a] = math::sin_cos(arm.azimuth[i]);
    closure.by_p.row(k) << by_u * cos_a - by_v * sin_a, by_u * sin_a + by_v * cos_a, by_w;
    closure.by_q[k] = arm.a * (by_u * sin_q - by_w * cos_q);
  }
  return closure;
}

}  // namespace

int DeltaArm::forward_from(const Eigen::Vector3d& p_begin, const Eigen::Vector3d& q,
                           Eigen::Vector3d& p_BT, Eigen::Matrix3d& J_BT) const noexcept {
  // Newton's steps double the number of correct digits each time, so a step below 1 nm leaves a far
  // smaller error. A long step is shortened, so that the search does not cross the plane of the
  // legs to the mirrored solution behind it.
  constexpr double kClose = 1e-10;   // m
  constexpr double kStepMax = 0.03;  // m, a third of the workspace
  p_BT = p_begin;
  for (int step = 1; step <= kStepsMax; ++step) {
    const Closure closure = closure_at(*this, q, p_BT);
    const Eigen::Matrix3d inverse_by_p = closure.by_p.inverse();
    Eigen::Vector3d move = -inverse_by_p * closure.error;
    const double length = move.norm();
    if (!(length < HUGE_VAL)) break;
    if (length > kStepMax) move *= kStepMax / length;
    p_BT += move;
    if (length < kClose) {
      const Closure at_end = closure_at(*this, q, p_BT);
      J_BT = -at_end.by_p.inverse() * at_end.by_q.asDiagonal();
      return step;
    }
  }
  p_BT.setConstant(std::numeric_limits<double>::quiet_NaN());
  J_BT.setConstant(std::numeric_limits<double>::quiet_NaN());
  return 0;
}

void DeltaArm::forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
                       Eigen::Matrix3d& J_BT) const noexcept {
  forward_from(p_BM, q, p_BT, J_BT);
}

std::optional<Eigen::Vector3d> DeltaArm::inverse(const Eigen::Vector3d& p_BT) const noexcept {
  Eigen::Vector3d q;
  for (std::size_t i = 0; i < 3; ++i) {
    const LegEnd end = leg_end(*this, i, p_BT);
    const double side_squared = b * b - end.v * end.v;
    if (!(side_squared > 0)) return std::nullopt;
    // In the leg's plane a triangle remains: upper link a, the remainder rho, and the leg's end.
    const double rho = std::sqrt(side_squared) + d + e;
    const double distance = math::hypot(end.u, end.w);
    const double cos_inner = (a * a + distance * distance - rho * rho) / (2 * a * distance);
    if (!(std::abs(cos_inner) < 1)) return std::nullopt;
    q[static_cast<Eigen::Index>(i)] = math::atan2(end.w, end.u) - math::acos(cos_inner);
  }
  return q;
}

}  // namespace thimble::driver
