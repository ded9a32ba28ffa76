#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <vector>

#include "thimble/device_sim/settings.h"
#include "thimble/driver/serial_arm.h"

namespace thimble::support {

/// One rigid body of a serial arm. Its centre is `along_b` (m) along link B and `along_c` along
/// link C from the shoulder, and it turns with one of them.
struct LinkBody {
  double mass = 0;  ///< kg
  double along_b = 0, along_c = 0;
  bool turns_with_c = false;
  /// Inertias about its centre: about the link, about the horizontal axis, about the third, kg m^2.
  double axial = 0, pitch = 0, third = 0;
};

/// An arm of rigid bodies whose equations of motion follow from their positions and orientations by
/// numerical differentiation only (Lagrange). The reference shares no code with the simulated arm.
class RigidLinks {
 public:
  RigidLinks(std::vector<LinkBody> bodies, const Eigen::Vector3d& gravity_B)
      : bodies_(std::move(bodies)), gravity_B_(gravity_B) {}

  /// Returns the kinetic energy, J.
  double kinetic(const Eigen::Vector3d& q, const Eigen::Vector3d& rate) const {
    double energy = 0;
    for (const LinkBody& body : bodies_) {
      const Eigen::Vector3d ahead = q + kStep * rate, behind = q - kStep * rate;
      const Eigen::Vector3d v = (centre(body, ahead) - centre(body, behind)) / (2 * kStep);
      const Eigen::Matrix3d R_dot = (turn(body, ahead) - turn(body, behind)) / (2 * kStep);
      const Eigen::Matrix3d spin = turn(body, q).transpose() * R_dot;
      const Eigen::Vector3d w(spin(2, 1), spin(0, 2), spin(1, 0));
      const Eigen::Vector3d inertia(body.third, body.pitch, body.axial);
      energy += 0.5 * body.mass * v.squaredNorm() + 0.5 * w.dot(inertia.cwiseProduct(w));
    }
    return energy;
  }

  /// Returns the potential energy of the weight, J.
  double potential(const Eigen::Vector3d& q) const {
    double energy = 0;
    for (const LinkBody& body : bodies_) energy -= body.mass * gravity_B_.dot(centre(body, q));
    return energy;
  }

  Eigen::Matrix3d inertia(const Eigen::Vector3d& q) const {
    Eigen::Matrix3d M;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        const Eigen::Vector3d a = Eigen::Vector3d::Unit(i), b = Eigen::Vector3d::Unit(j);
        M(i, j) = 0.5 * (kinetic(q, a + b) - kinetic(q, a - b));
      }
    }
    return M;
  }

  /// Returns g(q) - C(q, rate) rate, N m.
  Eigen::Vector3d torque(const Eigen::Vector3d& q, const Eigen::Vector3d& rate) const {
    const Eigen::Matrix3d M_dot =
        (inertia(q + kStep * rate) - inertia(q - kStep * rate)) / (2 * kStep);
    Eigen::Vector3d torque = -M_dot * rate;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(i);
      torque[i] += (kinetic(q + step, rate) - kinetic(q - step, rate) - potential(q + step) +
                    potential(q - step)) /
                   (2 * kStep);
    }
    return torque;
  }

  /// Returns the bodies as settings of the simulated arm.
  device_sim::LinkSettings settings() const {
    device_sim::LinkSettings links;
    for (const LinkBody& body : bodies_) {
      const double m = body.mass, b = body.along_b, c = body.along_c;
      links.inertia += Eigen::Vector3d(body.axial, m * b * b, m * c * c);
      links.inertia[body.turns_with_c ? 2 : 1] += body.pitch;
      links.yaw_b += m * b * b;
      links.yaw_c += m * c * c;
      (body.turns_with_c ? links.yaw_c : links.yaw_b) += body.third - body.axial;
      links.coupling += m * b * c;
      links.moment_b += m * b;
      links.moment_c += m * c;
    }
    links.gravity_B = gravity_B_;
    return links;
  }

 private:
  static constexpr double kStep = 1e-4;

  static Eigen::Matrix3d turn(const LinkBody& body, const Eigen::Vector3d& q) {
    // Link B points up at B = 0 and falls outwards; link C points down at C = 0 and rises outwards.
    const Eigen::AngleAxisd yaw(q[0], Eigen::Vector3d::UnitZ());
    const double fall = body.turns_with_c ? -q[2] : q[1];
    return (yaw * Eigen::AngleAxisd(fall, Eigen::Vector3d::UnitY())).toRotationMatrix();
  }
  static Eigen::Vector3d centre(const LinkBody& body, const Eigen::Vector3d& q) {
    const LinkBody b{.turns_with_c = false}, c{.turns_with_c = true};
    return turn(b, q) * Eigen::Vector3d(0, 0, body.along_b) +
           turn(c, q) * Eigen::Vector3d(0, 0, -body.along_c);
  }

  std::vector<LinkBody> bodies_;
  Eigen::Vector3d gravity_B_;
};

/// Returns links with the masses of a desk arm of this geometry: both links, the rod of the linkage
/// along B, a counterweight behind the shoulder, and a turning base. `more` scales the masses.
inline RigidLinks desk_links(const driver::SerialArm& arm, double more = 1,
                             const Eigen::Vector3d& gravity_B = {0, 0, -9.80665}) {
  const double b = arm.length_b, c = arm.length_c;
  std::vector<LinkBody> bodies{
      {.mass = 0.03, .along_b = 0.45 * b, .axial = 2e-6, .pitch = 5e-5, .third = 6e-5},
      {.mass = 0.02,
       .along_b = b,
       .along_c = 0.4 * c,
       .turns_with_c = true,
       .axial = 1e-6,
       .pitch = 3e-5,
       .third = 2e-5},
      {.mass = 0.015,
       .along_b = 0.5 * b,
       .along_c = -0.3 * c,
       .axial = 1e-6,
       .pitch = 2e-5,
       .third = 2e-5},
      {.mass = 0.12, .along_b = -0.2 * b, .axial = 2e-5, .pitch = 2e-5, .third = 3e-5},
      {.mass = 0, .axial = 2e-4}};
  for (LinkBody& body : bodies) {
    for (double* value : {&body.mass, &body.axial, &body.pitch, &body.third}) *value *= more;
  }
  return {bodies, gravity_B};
}

}  // namespace thimble::support
