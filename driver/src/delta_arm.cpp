#include "thimble/driver/delta_arm.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "math/elementary.h"

namespace thimble::driver {
namespace {

/// One leg at given angles; computed once for all steps of the search.
struct Leg {
  double sin_a, cos_a;  // Direction of u.
  double sin_q, cos_q;  // Upper link.
};
using Legs = std::array<Leg, 3>;

Legs legs_at(const DeltaArm& arm, const Eigen::Vector3d& q) noexcept {
  Legs legs;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto [sin_q, cos_q] = math::sin_cos(q[static_cast<Eigen::Index>(i)]);
    legs[i] = {arm.outwards[i].y(), arm.outwards[i].x(), sin_q, cos_q};
  }
  return legs;
}

/// The end of one leg in the leg's own frame, m.
struct LegEnd {
  double u, v, w;
};

LegEnd leg_end(const DeltaArm& arm, double sin_a, double cos_a,
               const Eigen::Vector3d& p_BT) noexcept {
  return {cos_a * p_BT.x() + sin_a * p_BT.y() - arm.r + arm.c,
          -sin_a * p_BT.x() + cos_a * p_BT.y() - arm.s + arm.f, p_BT.z()};
}

/// Closure error of each leg (m^2), and its derivatives by tip and leg angles.
struct Closure {
  Eigen::Vector3d error;
  Eigen::Matrix3d by_p;
  Eigen::Vector3d by_q;
};

Closure closure_at(const DeltaArm& arm, const Legs& legs, const Eigen::Vector3d& p_BT) noexcept {
  Closure closure;
  const double offset = arm.d + arm.e;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto k = static_cast<Eigen::Index>(i);
    const auto& [sin_a, cos_a, sin_q, cos_q] = legs[i];
    const LegEnd end = leg_end(arm, sin_a, cos_a, p_BT);
    const double u = end.u - arm.a * cos_q;
    const double w = end.w - arm.a * sin_q;
    const double rho = std::sqrt(u * u + w * w);
    const double reach = rho - offset;
    closure.error[k] = reach * reach + end.v * end.v - arm.b * arm.b;
    // d(reach^2) = 2 reach drho, drho = (u du + w dw) / rho
    const double by_rho = 2 * reach / rho;
    const double by_u = by_rho * u, by_w = by_rho * w, by_v = 2 * end.v;
    closure.by_p.row(k) << by_u * cos_a - by_v * sin_a, by_u * sin_a + by_v * cos_a, by_w;
    closure.by_q[k] = arm.a * (by_u * sin_q - by_w * cos_q);
  }
  return closure;
}

/// Replaces the torus of each leg by a sphere with the radius b + d + e around the elbow, and
/// returns the point on all three that is on the side of `p_side`. It is exact where the
/// parallelograms are not turned. `p_side` if the spheres have no such point.
Eigen::Vector3d near_tip(const DeltaArm& arm, const Legs& legs,
                         const Eigen::Vector3d& p_side) noexcept {
  // Where the tip were if a leg had no length after its elbow: centres of spheres for the tip.
  std::array<Eigen::Vector3d, 3> centre;
  for (std::size_t i = 0; i < 3; ++i) {
    const auto& [sin_a, cos_a, sin_q, cos_q] = legs[i];
    const double u = arm.r - arm.c + arm.a * cos_q, v = arm.s - arm.f;
    centre[i] = {cos_a * u - sin_a * v, sin_a * u + cos_a * v, arm.a * sin_q};
  }
  // The spheres have equal radii, so the tip is above the centre of the circle through the centres.
  const Eigen::Vector3d to_1 = centre[1] - centre[0], to_2 = centre[2] - centre[0];
  const Eigen::Vector3d normal = to_1.cross(to_2);
  const double normal_squared = normal.squaredNorm();
  const Eigen::Vector3d to_foot =
      (to_1.squaredNorm() * to_2.cross(normal) + to_2.squaredNorm() * normal.cross(to_1)) /
      (2 * normal_squared);
  const double radius = arm.b + arm.d + arm.e;
  const double height_squared = radius * radius - to_foot.squaredNorm();
  if (!(height_squared > 0)) return p_side;
  const double height = std::sqrt(height_squared / normal_squared);
  const Eigen::Vector3d foot = centre[0] + to_foot;
  const double side = normal.dot(p_side - foot) < 0 ? -height : height;
  return foot + side * normal;
}

int search(const DeltaArm& arm, const Legs& legs, const Eigen::Vector3d& p_begin,
           Eigen::Vector3d& p_BT, Eigen::Matrix3d& J_BT) noexcept {
  // Newton's steps double the number of correct digits each time, so a step below 1 pm leaves a far
  // smaller error, also in the Jacobian of the point before it. A long step is shortened, so that
  // the search does not cross the plane of the legs to the mirrored solution behind it.
  constexpr double kClose = 1e-12;   // m
  constexpr double kStepMax = 0.03;  // m, a third of the workspace
  p_BT = p_begin;
  for (int step = 1; step <= DeltaArm::kStepsMax; ++step) {
    const Closure closure = closure_at(arm, legs, p_BT);
    const Eigen::Matrix3d inverse_by_p = closure.by_p.inverse();
    Eigen::Vector3d move = -inverse_by_p * closure.error;
    const double length = move.norm();
    if (!(length < HUGE_VAL)) break;
    if (length > kStepMax) move *= kStepMax / length;
    p_BT += move;
    if (length < kClose) {
      J_BT = -inverse_by_p * closure.by_q.asDiagonal();
      return step;
    }
  }
  p_BT.setConstant(std::numeric_limits<double>::quiet_NaN());
  J_BT.setConstant(std::numeric_limits<double>::quiet_NaN());
  return 0;
}

}  // namespace

int DeltaArm::forward_from(const Eigen::Vector3d& p_begin, const Eigen::Vector3d& q,
                           Eigen::Vector3d& p_BT, Eigen::Matrix3d& J_BT) const noexcept {
  return search(*this, legs_at(*this, q), p_begin, p_BT, J_BT);
}

void DeltaArm::forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
                       Eigen::Matrix3d& J_BT) const noexcept {
  const Legs legs = legs_at(*this, q);
  search(*this, legs, near_tip(*this, legs, p_BM), p_BT, J_BT);
}

std::optional<Eigen::Vector3d> DeltaArm::inverse(const Eigen::Vector3d& p_BT) const noexcept {
  Eigen::Vector3d q;
  for (std::size_t i = 0; i < 3; ++i) {
    const LegEnd end = leg_end(*this, outwards[i].y(), outwards[i].x(), p_BT);
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
