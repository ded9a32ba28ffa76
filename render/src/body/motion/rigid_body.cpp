#include "body/motion/rigid_body.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "body/motion/floor_impulses.h"
#include "math/elementary.h"

namespace thimble::render {
namespace {

using Eigen::Vector3d;

constexpr double kForceMax = 1e6;  // N or N m; no arm pushes harder

bool is_force(const Vector3d& f) {
  // Written so that NaN means no force.
  return f.squaredNorm() <= kForceMax * kForceMax;
}

bool usable(double x) {
  return x >= 0 && std::isfinite(x);
}

}  // namespace

driver::Result<RigidBody> RigidBody::build(const RigidBodySettings& settings) {
  if (!settings.mass.valid()) {
    return driver::Error{
        "A body needs a mass and three moments of inertia above 0, none larger than the sum of the "
        "other two. Compute them from the mesh with mass_properties."};
  }
  if (!settings.gravity_W.allFinite() || !usable(settings.damping) ||
      !usable(settings.angular_damping)) {
    return driver::Error{"A body needs finite gravity and finite dampings of 0 or more."};
  }
  if (!(settings.time_scale > 0) || !std::isfinite(settings.time_scale)) {
    return driver::Error{"A body needs a time_scale above 0; 1 is the natural speed."};
  }
  if (settings.floor &&
      (!usable(settings.floor->friction) || !std::isfinite(settings.floor->height) ||
       !(std::abs(settings.floor->n_W.norm() - 1) < 1e-9))) {
    return driver::Error{
        "A floor needs a unit normal, a finite height, and friction of 0 or more."};
  }
  if (settings.support_B.size() > kSupportMax) {
    return driver::Error{"A body can have at most " + std::to_string(kSupportMax) +
                         " support points. Use the corners of its hull."};
  }
  for (const Vector3d& p : settings.support_B) {
    if (!p.allFinite()) return driver::Error{"A support point of the body is not finite."};
  }
  return RigidBody(settings);
}

void RigidBody::push(const Vector3d& f_W, const Vector3d& p_W) noexcept {
  const Vector3d tau = (p_W - p_WC_).cross(f_W);
  if (!is_force(f_W) || !is_force(tau)) return;
  f_W_ += f_W;
  tau_W_ += tau;
}

void RigidBody::load(const Vector3d& f_W, const Vector3d& tau_W) noexcept {
  if (!is_force(f_W) || !is_force(tau_W)) return;
  f_W_ = f_W;
  tau_W_ = tau_W;
}

void RigidBody::place(const Vector3d& p_WC, const Eigen::Quaterniond& q_WB, const Vector3d& v_W,
                      const Vector3d& omega_W) noexcept {
  p_WC_ = p_WC;
  q_WB_ = q_WB;
  momentum_W_ = settings_.mass.mass * v_W;
  angular_W_ = q_WB * settings_.mass.inertia.cwiseProduct(q_WB.conjugate() * omega_W);
  f_W_.setZero();
  tau_W_.setZero();
}

Vector3d RigidBody::omega_W() const noexcept {
  const Vector3d angular_B = q_WB_.conjugate() * angular_W_;
  return q_WB_ * angular_B.cwiseQuotient(settings_.mass.inertia);
}

Vector3d RigidBody::velocity_at(const Vector3d& p_W) const noexcept {
  return settings_.time_scale * (v_WC() + omega_W().cross(p_W - p_WC_));
}

// Returns the velocity that the point at `arm` from C gains by an impulse f there.
Vector3d RigidBody::velocity_response(const Vector3d& arm, const Vector3d& f) const noexcept {
  const Vector3d turn_B = (q_WB_.conjugate() * arm.cross(f)).cwiseQuotient(settings_.mass.inertia);
  return f / settings_.mass.mass + (q_WB_ * turn_B).cross(arm);
}

void RigidBody::kick(double time) noexcept {
  momentum_W_ += time * (f_W_ + settings_.mass.mass * settings_.gravity_W);
  angular_W_ += time * tau_W_;
}

// Half a step of damping: each component of the angular momentum in B falls by the rate c / I of
// its axis, so that the torque is -c times the turning rate.
void RigidBody::fade() noexcept {
  if (settings_.damping > 0) momentum_W_ *= fading_.momentum;
  if (settings_.angular_damping > 0) {
    const Vector3d angular_B = q_WB_.conjugate() * angular_W_;
    angular_W_ = q_WB_ * angular_B.cwiseProduct(fading_.angular);
  }
}

// The factors of `fade` in steps of `time`, computed again if the step has changed.
void RigidBody::prepare_fading(double time) noexcept {
  if (fading_.time == time) return;
  fading_.time = time;
  fading_.momentum = math::exp(-settings_.damping / settings_.mass.mass * time / 2);
  for (int k = 0; k < 3; ++k) {
    fading_.angular[k] =
        math::exp(-settings_.angular_damping / settings_.mass.inertia[k] * time / 2);
  }
}

void RigidBody::step(double step) noexcept {
  // Written so that NaN moves nothing.
  const double time = settings_.time_scale * step;
  if (time > 0 && std::isfinite(time)) {
    prepare_fading(time);
    kick(time / 2);
    fade();
    // Before the body moves: the velocity from the first half of the kick would move it through the
    // floor, and along it against any friction.
    if (settings_.floor) stand_on_floor(time, middle_of_turn(time));
    const Vector3d way = time * v_WC();
    p_WC_ += way;
    free_turn_.turn(time, angular_W_, q_WB_);
    fade();
    // Forces stay at their points in W while C moves, so the body gains exactly their angular
    // momentum about any point, to rounding.
    tau_W_ -= way.cross(f_W_);
    kick(time / 2);
    if (settings_.floor) {
      lift_out();
      stand_on_floor(time, q_WB_);
    }
  }
  f_W_.setZero();
  tau_W_.setZero();
}

// Returns the orientation of the body in the middle of a step. With arms from there, a corner about
// which the body turns stays in place, to order 2 of the step.
Eigen::Quaterniond RigidBody::middle_of_turn(double time) const noexcept {
  const Vector3d half = time / 4 * omega_W();
  Eigen::Quaterniond turn(1, half.x(), half.y(), half.z());
  return (turn * q_WB_).normalized();
}

// Removes the speed into the floor from points that are below it or would be after the next step.
// There is no rebound. Applies friction (floor_impulses.h). `q_WB` is the body's orientation.
// Looking ahead lets a side come to rest flat: all its corners count at once.
void RigidBody::stand_on_floor(double time, const Eigen::Quaterniond& q_WB) noexcept {
  const Floor& floor = *settings_.floor;
  // Points that the next step cannot bring to the floor, at four times the speed, are skipped.
  constexpr double kAhead = 4;
  constexpr double kNear = 1e-3;  // of the point's distance from C
  const Vector3d v_WC = this->v_WC();
  const double speed = v_WC.norm(), turning = omega_W().norm();
  const double height = floor.n_W.dot(p_WC_) - floor.height;
  FloorImpulses impulses(settings_.mass.mass, settings_.mass.inertia, q_WB.conjugate() * floor.n_W,
                         floor.friction);
  const Vector3d n_B = q_WB_.conjugate() * floor.n_W;
  for (const Vector3d& p_B : settings_.support_B) {
    const double gap = height + n_B.dot(p_B);
    const double far = p_B.norm();
    if (!(gap <= kAhead * time * (speed + turning * far) + kNear * far)) continue;
    impulses.add(p_B, std::max(gap, 0.0) / time);
  }
  Vector3d v_B = q_WB.conjugate() * v_WC;
  Vector3d omega_B = (q_WB.conjugate() * angular_W_).cwiseQuotient(settings_.mass.inertia);
  if (!impulses.solve(v_B, omega_B)) ++floor_unsolved_;
  momentum_W_ = settings_.mass.mass * (q_WB * v_B);
  angular_W_ = q_WB * settings_.mass.inertia.cwiseProduct(omega_B);
}

// Moves the body up if its turn has brought a point below the floor.
void RigidBody::lift_out() noexcept {
  const Floor& floor = *settings_.floor;
  const double height = floor.n_W.dot(p_WC_) - floor.height;
  const Vector3d n_B = q_WB_.conjugate() * floor.n_W;
  double deepest = 0;
  for (const Vector3d& p_B : settings_.support_B) {
    deepest = std::max(deepest, -(height + n_B.dot(p_B)));
  }
  p_WC_ += deepest * floor.n_W;
}

void RigidBody::keep_within(double reach) noexcept {
  const Vector3d away = p_WC_ - settings_.mass.p_WC;
  const double far = away.norm();
  // Written so that NaN moves nothing.
  if (!(far > reach) || !(reach >= 0)) return;
  const Vector3d n = away / far;
  p_WC_ = settings_.mass.p_WC + reach * n;
  momentum_W_ -= std::max(momentum_W_.dot(n), 0.0) * n;
}

double RigidBody::kinetic_energy() const noexcept {
  return momentum_W_.squaredNorm() / (2 * settings_.mass.mass) + angular_W_.dot(omega_W()) / 2;
}

double RigidBody::potential_energy() const noexcept {
  return -settings_.mass.mass * settings_.gravity_W.dot(p_WC_);
}

}  // namespace thimble::render
