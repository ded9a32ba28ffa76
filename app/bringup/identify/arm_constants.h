#pragma once

#include <array>
#include <optional>

#include "bringup/identify/line_forces.h"
#include "bringup/identify/motion_fit.h"

namespace thimble::bringup {

/// One joint's motor and cable as they are written into an arm file, with their intervals.
struct CableConstants {
  Estimate inertia;        ///< Of motor and pulley, kg m^2 at the joint.
  Estimate stiffness;      ///< Of the cable, N m/rad at the joint.
  Estimate damping;        ///< N m s/rad
  Estimate play;           ///< Whole width, rad at the joint; 0 where none was seen.
  Estimate viscous;        ///< Friction of the motor's side, N m s/rad at the joint; 0 likewise.
  Estimate coulomb;        ///< Its dry friction, N m at the joint; 0 likewise.
  Estimate antiresonance;  ///< At which the link oscillates on its cable, the motor held, Hz.
  Estimate resonance;      ///< At which motor and link oscillate against each other, Hz.

  /// Returns whether one of the two is seen: below the highest line, and to 5 %. What is above is
  /// concluded from inertia and stiffness.
  static bool sees(const Estimate& frequency) {
    return frequency.value < LineForces::kHighest && frequency.plus_minus < 0.05 * frequency.value;
  }
};

/// Links of a serial arm as they are written into an arm file (device_sim::LinkSettings), kg m^2
/// and kg m, with their intervals.
struct LinkConstants {
  std::array<Estimate, 3> inertia;  ///< About A, B and C.
  Estimate yaw_b, yaw_c, coupling;
  Estimate moment_b, moment_c;
};

/// Constants of an arm as they are written into its file, with their intervals.
struct ArmConstants {
  Estimate mass;                 ///< At the tip, kg.
  Estimate viscous;              ///< N s/m
  Estimate coulomb;              ///< N per axis
  Estimate weight;               ///< What gravity pulls on the tip with, N.
  std::array<Estimate, 3> gain;  ///< True torque over that of the arm file, joint by joint.
  Estimate delay;                ///< From force to seen motion, s.
  /// The scale of masses and forces was measured with a known mass. If not, the gains' geometric
  /// mean was taken to be 1, and all but the delay are as wrong as that.
  bool absolute = false;
  /// Of motors and cables, where these were seen to stretch. Mass, friction and weight are those of
  /// the links then.
  std::optional<std::array<CableConstants, 3>> cables;
  /// Whether motion at several places was looked at for links, and those that were seen. Mass,
  /// friction and weight are those of the tip beside them then.
  bool links_sought = false;
  std::optional<LinkConstants> links;
  double misfit = 0;  ///< With a known mass: chi^2 per degree of freedom of both motions together.
};

/// Widens an interval by what a method costs beyond its statistics, one standard deviation of it.
void widen(Estimate& estimate, double method);

/// Returns a torque by the arm file's constants (or one over something) as the true one.
/// Real-time: never from the servo thread.
Estimate by_gain(const Estimate& torque, const Estimate& gain);

/// Returns the constants that the motion of a bare tip means, or those of two motions together, the
/// second with a known mass on the tip: it moves as much slower as its mass is more, whatever the
/// motors' constants. The error says why there is no such arm.
/// Real-time: never from the servo thread.
driver::Result<ArmConstants> arm_constants(const PerMass& bare, const Eigen::Vector3d& down_B,
                                           const std::optional<PerMass>& loaded, double added_mass);

}  // namespace thimble::bringup
