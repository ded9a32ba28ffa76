#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <limits>
#include <optional>

#include "body/motion/body_frame.h"
#include "body/motion/rigid_body.h"
#include "body/motion/translating_body.h"
#include "body/motion/turn.h"

namespace thimble::render {

// The two kinds of motion of an object as a whole [BP 4.3]; see BodyMotion (moving_touch.h).

/// Moves an object in three degrees of freedom: a TranslatingBody with gravity, a floor and a
/// reach.
class TranslatingMotion {
 public:
  /// Loads and limits of the body, in addition to contact.
  struct Settings {
    double mass = 1;                     ///< kg
    Eigen::Vector3d gravity_W{0, 0, 0};  ///< m/s^2
    std::optional<Floor> floor{};        ///< Floor that the body cannot pass.
    double lowest =
        0;  ///< m along the floor's normal: height of the object's lowest point at first
    double reach = std::numeric_limits<double>::infinity();  ///< m; see RigidBody::keep_within
  };

  TranslatingMotion(const TranslatingBody& body, const Settings& settings) noexcept
      : body_(body), settings_(settings) {}

  Eigen::Matrix3d R_WB() const noexcept { return Eigen::Matrix3d::Identity(); }
  Eigen::Vector3d p_WB() const noexcept { return body_.p_W(); }
  BodyFrame frame_after(double time) const noexcept {
    return {.R_WB = R_WB(), .p_WB = p_WB() + time * body_.velocity()};
  }
  Eigen::Vector3d velocity_at(const Eigen::Vector3d&) const noexcept { return body_.velocity(); }
  Eigen::Vector3d gain_at(const Eigen::Vector3d&, const Eigen::Vector3d& impulse) const noexcept {
    return body_.gain() * impulse;
  }
  void push(const Eigen::Vector3d& f_W, const Eigen::Vector3d&) noexcept { body_.push(f_W); }
  /// Advances by the step for which the body was made.
  void step(double) noexcept {
    body_.push(settings_.mass * settings_.gravity_W);
    if (settings_.floor) {
      const Floor& floor = *settings_.floor;
      body_.step_on_floor(floor.n_W, floor.height - settings_.lowest, floor.friction);
    } else {
      body_.step();
    }
    const double far = body_.p_W().norm();
    if (far > settings_.reach) body_.keep_above(-body_.p_W() / far, -settings_.reach);
  }
  /// Returns the energy of motion and height, J (see BodyMotion). Real-time: safe.
  double energy() const noexcept {
    return body_.kinetic_energy() - settings_.mass * settings_.gravity_W.dot(body_.p_W());
  }
  const TranslatingBody& body() const noexcept { return body_; }

 private:
  TranslatingBody body_;
  Settings settings_;
};

/// Moves an object in six degrees of freedom: a RigidBody with a reach.
class RigidMotion {
 public:
  /// Takes a body at rest at the place of its mesh, and its reach (m).
  RigidMotion(const RigidBody& body, double reach) noexcept : body_(body), reach_(reach) {}

  const Eigen::Matrix3d& R_WB() const noexcept { return R_WB_; }
  const Eigen::Vector3d& p_WB() const noexcept { return p_WB_; }
  BodyFrame frame_after(double time) const noexcept {
    const MassProperties& first = body_.settings().mass;
    const Eigen::Vector3d turn_W = time * body_.settings().time_scale * body_.omega_W();
    BodyFrame frame{.R_WB = R_WB_};
    if (turn_W.squaredNorm() > 0) frame.R_WB = turn_by(turn_W).toRotationMatrix() * R_WB_;
    frame.p_WB =
        body_.p_WC() + time * body_.settings().time_scale * body_.v_WC() - frame.R_WB * first.p_WC;
    return frame;
  }
  Eigen::Vector3d velocity_at(const Eigen::Vector3d& p_W) const noexcept {
    return body_.velocity_at(p_W);
  }
  Eigen::Vector3d gain_at(const Eigen::Vector3d& p_W,
                          const Eigen::Vector3d& impulse) const noexcept {
    return body_.gain_at(p_W, impulse);
  }
  void push(const Eigen::Vector3d& f_W, const Eigen::Vector3d& p_W) noexcept {
    body_.push(f_W, p_W);
  }
  void step(double step) noexcept {
    body_.step(step);
    take_place();
  }
  /// Moves the body instead of a step, as RigidBody::place.
  void place(const Eigen::Vector3d& p_WC, const Eigen::Quaterniond& q_WB,
             const Eigen::Vector3d& v_W, const Eigen::Vector3d& omega_W) noexcept {
    body_.place(p_WC, q_WB, v_W, omega_W);
    take_place();
  }
  /// Returns the energy of motion and height, J (see BodyMotion). Real-time: safe.
  double energy() const noexcept { return body_.kinetic_energy() + body_.potential_energy(); }
  const RigidBody& body() const noexcept { return body_; }
  /// Returns the body, to set its velocity or its load before a tick.
  RigidBody& body() noexcept { return body_; }

 private:
  void take_place() noexcept {
    body_.keep_within(reach_);
    const MassProperties& first = body_.settings().mass;
    R_WB_ = (body_.q_WB() * first.q_WB.conjugate()).normalized().toRotationMatrix();
    p_WB_ = body_.p_WC() - R_WB_ * first.p_WC;
  }

  RigidBody body_;
  double reach_;
  Eigen::Matrix3d R_WB_ = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_WB_{0, 0, 0};
};

}  // namespace thimble::render
