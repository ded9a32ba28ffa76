#include <cmath>
#include <limits>
#include <numbers>

#include "cross_product.h"
#include "math/elementary.h"
#include "thimble/driver/arm_model.h"
#include "thimble/driver/linkage_arm.h"

namespace thimble::driver {
namespace {

/// Elbows and tip in the plane, m.
struct Bars {
  Eigen::Vector2d elbow_1, elbow_2, tip;
};

/// Returns the bars at crank directions u_1 and u_2. The tip is NaN if the distal links do not
/// meet.
Bars bars_at(const FiveBarArm& arm, const Eigen::Vector2d& u_1,
             const Eigen::Vector2d& u_2) noexcept {
  const Eigen::Vector2d motor(arm.base / 2, 0);
  Bars bars{.elbow_1 = arm.crank_1 * u_1 - motor, .elbow_2 = arm.crank_2 * u_2 + motor, .tip = {}};
  // The triangle over the line between the elbows: `along` it and `aside` to its left.
  const Eigen::Vector2d between = bars.elbow_2 - bars.elbow_1;
  const double length_squared = between.squaredNorm();
  const double share =
      0.5 + (arm.distal_1 * arm.distal_1 - arm.distal_2 * arm.distal_2) / (2 * length_squared);
  const double aside_squared = arm.distal_1 * arm.distal_1 / length_squared - share * share;
  // NaN if the triangle does not close; also if the elbows coincide (infinity minus infinity).
  const double aside =
      aside_squared >= 0 ? std::sqrt(aside_squared) : std::numeric_limits<double>::quiet_NaN();
  const Eigen::Vector2d left(-between.y(), between.x());
  bars.tip = bars.elbow_1 + share * between + aside * left;
  return bars;
}

/// Returns the angle of a crank whose elbow is on the left (`side` = 1) or right (-1) of the line
/// from its motor to the tip; NaN if the tip is out of reach. `to_tip`: from the motor, m. The
/// direction of the tip has its cut behind the arm, so that angles are continuous before it.
double crank_angle(const Eigen::Vector2d& to_tip, double crank, double distal,
                   double side) noexcept {
  const double reach = to_tip.norm();
  const double cosine = (reach * reach + crank * crank - distal * distal) / (2 * reach * crank);
  const double direction = math::atan2(-to_tip.x(), to_tip.y()) + std::numbers::pi / 2;
  return direction + side * math::acos(cosine);
}

}  // namespace

std::string_view name(FiveBarPose pose) noexcept {
  switch (pose) {
    case FiveBarPose::kRegular:
      return "regular";
    case FiveBarPose::kOpen:
      return "distal links do not meet";
    case FiveBarPose::kStretched:
      return "distal links stretched";
    case FiveBarPose::kFolded:
      return "distal links folded";
    case FiveBarPose::kLegStraight:
      return "crank and distal link in line";
  }
  return "unknown";
}

// The tip P is distal_k away from elbow E_k: (P - E_k).dP = (P - E_k).dE_k. The rows (P - E_k)^T
// form M and the right sides a diagonal D, so J = M^-1 D.
void FiveBarArm::forward(const Eigen::Vector3d& q, Eigen::Vector3d& p_BT,
                         Eigen::Matrix3d& J_BT) const noexcept {
  const auto [sin_1, cos_1] = math::sin_cos(q[0]);
  const auto [sin_2, cos_2] = math::sin_cos(q[1]);
  const Bars bars = bars_at(*this, {cos_1, sin_1}, {cos_2, sin_2});
  const Eigen::Vector2d a = bars.tip - bars.elbow_1, b = bars.tip - bars.elbow_2;
  const double area = cross(a, b);
  const double by_1 = crank_1 * (a.y() * cos_1 - a.x() * sin_1) / area;
  const double by_2 = crank_2 * (b.y() * cos_2 - b.x() * sin_2) / area;
  p_BT = {bars.tip.x(), bars.tip.y(), q[2]};
  // clang-format off
  J_BT <<  b.y() * by_1, -a.y() * by_2, 0,
          -b.x() * by_1,  a.x() * by_2, 0,
                      0,             0, 1;
  // clang-format on
}

std::optional<Eigen::Vector3d> FiveBarArm::inverse(const Eigen::Vector3d& p_BT) const noexcept {
  if (!lies_on_axes(p_BT, motors())) return std::nullopt;
  const Eigen::Vector2d tip(p_BT.x(), p_BT.y()), motor(base / 2, 0);
  const Eigen::Vector3d q(crank_angle(tip + motor, crank_1, distal_1, 1),
                          crank_angle(tip - motor, crank_2, distal_2, -1), 0);
  // Written so that NaN is out of reach.
  if (!(q.squaredNorm() < HUGE_VAL)) return std::nullopt;
  const Eigen::Vector2d elbow_1 =
      crank_1 * Eigen::Vector2d(math::cos(q[0]), math::sin(q[0])) - motor;
  const Eigen::Vector2d elbow_2 =
      crank_2 * Eigen::Vector2d(math::cos(q[1]), math::sin(q[1])) + motor;
  // `forward` has the tip on the left of the line between the elbows; so must this solution.
  if (!(cross(elbow_2 - elbow_1, tip - elbow_1) > 0)) return std::nullopt;
  return q;
}

FiveBarPose FiveBarArm::configuration(const Eigen::Vector3d& q) const noexcept {
  const Eigen::Vector2d u_1(math::cos(q[0]), math::sin(q[0])),
      u_2(math::cos(q[1]), math::sin(q[1]));
  const Bars bars = bars_at(*this, u_1, u_2);
  const Eigen::Vector2d a = (bars.tip - bars.elbow_1) / distal_1;
  const Eigen::Vector2d b = (bars.tip - bars.elbow_2) / distal_2;
  if (!(a.squaredNorm() < HUGE_VAL)) {
    return (bars.elbow_2 - bars.elbow_1).norm() > kSingular * distal_1 ? FiveBarPose::kOpen
                                                                       : FiveBarPose::kFolded;
  }
  if (std::abs(cross(a, b)) < kSingular) {
    return a.dot(b) < 0 ? FiveBarPose::kStretched : FiveBarPose::kFolded;
  }
  const bool straight = std::abs(cross(u_1, a)) < kSingular || std::abs(cross(u_2, b)) < kSingular;
  return straight ? FiveBarPose::kLegStraight : FiveBarPose::kRegular;
}

}  // namespace thimble::driver
