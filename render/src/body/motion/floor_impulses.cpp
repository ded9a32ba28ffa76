#include "body/motion/floor_impulses.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>

namespace thimble::render {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Penalty of an approach, as a share of the velocity that a point gains by an impulse on it. Each
// update of the multipliers reduces the error by about this share (more for slender bodies). The
// digits lost in the impulses are those of its inverse.
constexpr double kSoftness = 1e-3;

// Updates of multipliers and slips: 3 to 6 are usual.
constexpr int kUpdatesMax = 100;

// Maximum extrapolation of the secant beyond the last change of the slips, in units of that change.
constexpr double kSecantMax = 10;

// Evaluations of the slope along one direction of search.
constexpr int kSearchMax = 12;

// A step of Newton's method is accepted if the slope has fallen to this share.
constexpr double kSlopeLeft = 0.5;

// Rounding of the velocity of a point, as a share of the body's velocity.
constexpr double kPointRounding = 1e-15;

}  // namespace

FloorImpulses::FloorImpulses(double mass, const Vector3d& inertia, const Vector3d& n_B,
                             double friction) noexcept
    : root_mass_(Vector3d::Constant(std::sqrt(mass))),
      root_inertia_(inertia.cwiseSqrt()),
      friction_(friction) {
  // The tangent is computed from the axis that is farthest from the normal.
  Eigen::Index axis = 0;
  n_B.cwiseAbs().minCoeff(&axis);
  const Vector3d t = Vector3d::Unit(axis).cross(n_B).normalized();
  axes_.row(0) = n_B.transpose();
  axes_.row(1) = t.transpose();
  axes_.row(2) = n_B.cross(t).transpose();
}

void FloorImpulses::add(const Vector3d& arm_B, double allowed) noexcept {
  Point& point = points_[count_++];
  for (Eigen::Index k = 0; k < 3; ++k) {
    const Vector3d along = axes_.row(k).transpose();
    point.J.block<1, 3>(k, 0) = along.cwiseQuotient(root_mass_).transpose();
    point.J.block<1, 3>(k, 3) = arm_B.cross(along).cwiseQuotient(root_inertia_).transpose();
  }
  point.allowed = allowed;
}

// The argument of the projection: pressure of penalty and multiplier at velocity v.
Vector3d FloorImpulses::pressed(const Point& point, const Vector3d& v) const noexcept {
  const Vector3d off(v[0] + point.allowed + friction_ * point.slip, v[1], v[2]);
  return point.held - off / softness_;
}

// The impulse at velocity v: the argument above projected onto the friction cone.
Vector3d FloorImpulses::impulse(const Point& point, const Vector3d& v) const noexcept {
  const Vector3d z = pressed(point, v);
  const double mu = friction_;
  if (mu == 0) return {std::max(z[0], 0.0), 0, 0};
  const double along = z.tail<2>().norm();
  if (along <= mu * z[0]) return z;
  const double normal = (z[0] + mu * along) / (1 + mu * mu);
  if (!(normal > 0)) return Vector3d::Zero();
  const double share = mu * normal / along;
  return {normal, share * z[1], share * z[2]};
}

// Adds the derivative of minus the impulse's effect, J^T dP J / softness.
void FloorImpulses::add_curvature(const Point& point, Matrix6& hessian) const noexcept {
  const Vector3d z = pressed(point, point.v);
  const double mu = friction_;
  const auto& J = point.J;
  const double weight = 1 / softness_;
  if (mu == 0) {
    if (z[0] > 0) hessian.noalias() += weight * J.row(0).transpose() * J.row(0);
    return;
  }
  const double along = z.tail<2>().norm();
  if (along <= mu * z[0]) {
    hessian.noalias() += weight * J.transpose() * J;
    return;
  }
  const double normal = (z[0] + mu * along) / (1 + mu * mu);
  if (!(normal > 0)) return;
  const double c = z[1] / along, s = z[2] / along;
  // Along the cone's edge the impulse follows; across it, by the share by which the cone is
  // narrower.
  const Velocity edge = J.row(0) + mu * (c * J.row(1) + s * J.row(2));
  const Velocity across = c * J.row(2) - s * J.row(1);
  hessian.noalias() += weight / (1 + mu * mu) * edge * edge.transpose();
  hessian.noalias() += weight * mu * normal / along * across * across.transpose();
}

// Returns the share of the way at which the convex function is near its minimum.
double FloorImpulses::search(const Velocity& start, const Velocity& y, const Velocity& way,
                             double slope) const noexcept {
  const double rest = way.dot(y - start);
  const double rise = way.squaredNorm();
  const auto slope_at = [&](double share) {
    double sum = rest + share * rise;
    for (std::size_t i = 0; i < count_; ++i) {
      const Point& point = points_[i];
      sum -= point.change.dot(impulse(point, point.v + share * point.change));
    }
    return sum;
  };
  double low = 0, slope_low = slope, high = 1, slope_high = slope_at(1);
  if (std::abs(slope_high) <= kSlopeLeft * std::abs(slope) || slope_high < 0) return 1;
  for (int i = 0; i < kSearchMax; ++i) {
    // Regula falsi, kept away from the ends.
    const double guess = slope_low / (slope_low - slope_high);
    const double share = low + std::clamp(guess, 0.05, 0.95) * (high - low);
    const double now = slope_at(share);
    if (std::abs(now) <= kSlopeLeft * std::abs(slope)) return share;
    if (now < 0) {
      low = share;
      slope_low = now;
    } else {
      high = share;
      slope_high = now;
    }
  }
  return low;
}

// Minimises |y - start|^2 / 2 + softness / 2 sum |impulse|^2 over y.
void FloorImpulses::minimise(const Velocity& start, double small, Velocity& y) noexcept {
  while (iterations_ < iterations_max()) {
    ++iterations_;
    Matrix6 hessian = Matrix6::Identity();
    Velocity gradient = y - start;
    for (std::size_t i = 0; i < count_; ++i) {
      Point& point = points_[i];
      point.v.noalias() = point.J * y;
      gradient.noalias() -= point.J.transpose() * impulse(point, point.v);
      add_curvature(point, hessian);
    }
    // Written so that NaN ends it.
    if (!(gradient.norm() > small)) return;
    const Velocity way = -hessian.llt().solve(gradient);
    const double slope = gradient.dot(way);
    if (!(slope < 0)) return;
    for (std::size_t i = 0; i < count_; ++i) points_[i].change.noalias() = points_[i].J * way;
    y += search(start, y, way, slope) * way;
  }
}

// Sets the multipliers to the impulses and estimates the slips again. Returns the error of the
// velocities of the points with respect to the conditions, m/s.
double FloorImpulses::update() noexcept {
  double off = 0, falls = 0, change = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    Point& point = points_[i];
    const Vector3d now = impulse(point, point.v);
    off = std::max(off, softness_ * (now - point.held).norm());
    point.held = now;
    const double wrong = point.v.tail<2>().norm() - point.slip;
    // Without a load a slip has no effect.
    if (now[0] > 0) {
      off = std::max(off, friction_ * std::abs(wrong));
      const double less = wrong - point.wrong;
      falls += wrong * less;
      change += less * less;
    }
    point.wrong_before = point.wrong;
    point.wrong = wrong;
  }
  // The secant of the last two estimates [Anderson]. Without it each update would reduce the error
  // only by a share, which is near 1 if friction is large.
  const double further = change > 0 ? std::clamp(falls / change, -kSecantMax, 0.0) : 0;
  for (std::size_t i = 0; i < count_; ++i) {
    Point& point = points_[i];
    const double led_to = point.slip + point.wrong;
    const double led_to_before = point.slip_before + point.wrong_before;
    point.slip_before = point.slip;
    point.slip = std::max(led_to - further * (led_to - led_to_before), 0.0);
  }
  return off;
}

// Minimises, and updates multipliers and slips, until velocities are within `tolerance` (m/s).
bool FloorImpulses::iterate(const Velocity& start, double small, double tolerance,
                            Velocity& y) noexcept {
  for (int i = 0; i < kUpdatesMax && iterations_ < iterations_max(); ++i) {
    minimise(start, small, y);
    if (update() <= tolerance) return true;
  }
  return false;
}

// Velocity after the impulses, scaled down if it would raise the kinetic energy.
FloorImpulses::Velocity FloorImpulses::without_gain(const Velocity& start,
                                                    const Velocity& y) const noexcept {
  const Velocity change = y - start;
  // Energy falls by the impulses up to this share of them.
  const double most = -2 * start.dot(change) / change.squaredNorm();
  // Written so that NaN changes nothing.
  const double share = most >= 1 ? 1 : (most > 0 ? most : 0);
  return start + share * change;
}

bool FloorImpulses::solve(Vector3d& v_B, Vector3d& omega_B) noexcept {
  iterations_ = 0;
  if (count_ == 0) return true;
  Velocity start;
  start.head<3>() = root_mass_.cwiseProduct(v_B);
  start.tail<3>() = root_inertia_.cwiseProduct(omega_B);
  double gain = 0, approach = 0, speed = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    Point& point = points_[i];
    gain += point.J.row(0).squaredNorm() / static_cast<double>(count_);
    point.v.noalias() = point.J * start;
    point.slip = point.v.tail<2>().norm();
    approach = std::max(approach, -(point.v[0] + point.allowed));
    speed = std::max(speed, point.v.norm());
  }
  // The usual case: no point reaches the floor. Written so that NaN changes nothing.
  if (!(approach > 0) || !std::isfinite(start.squaredNorm())) return true;
  softness_ = kSoftness * gain;
  // Rounding of the points' velocities limits the accuracy.
  const double small = std::max(0.1 * kTolerance * speed / std::sqrt(gain),
                                kPointRounding / kSoftness * start.norm());
  Velocity y = start;
  const bool reached = iterate(start, small, kTolerance * speed, y);
  y = without_gain(start, y);
  if (!reached) {
    // Friction may be off by the residual, but no point may go through the floor.
    friction_ = 0;
    for (std::size_t i = 0; i < count_; ++i) points_[i].forget();
    const Velocity rough = y;
    const int before = std::exchange(iterations_, 0);
    iterate(rough, small, kTolerance * speed, y);
    y = without_gain(rough, y);
    iterations_ += before;
  }
  // The rest is below the tolerance: the body rests.
  if (!(y.norm() > kTolerance * start.norm())) y.setZero();
  v_B = y.head<3>().cwiseQuotient(root_mass_);
  omega_B = y.tail<3>().cwiseQuotient(root_inertia_);
  return reached;
}

}  // namespace thimble::render
