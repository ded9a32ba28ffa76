#pragma once

#include <array>
#include <optional>

#include "bringup/identify/line_forces.h"
#include "bringup/identify/motion_fit.h"

namespace thimble::bringup {

/// Constants of one joint's motor and cable for an arm file, with their intervals.
struct CableConstants {
  Estimate inertia;    ///< Inertia of motor and pulley, kg m^2 at the joint.
  Estimate stiffness;  ///< Stiffness of the cable, N m/rad at the joint.
  Estimate damping;    ///< N m s/rad
  Estimate play;       ///< Whole width of the backlash, rad at the joint; 0 if none was detected.
  Estimate viscous;    ///< Viscous friction of the motor's side, N m s/rad at the joint; 0 if none
                       ///< was detected.
  /// Dry friction of the motor's side, N m at the joint; 0 if none was detected.
  Estimate coulomb;
  Estimate antiresonance;  ///< Frequency of the link on its cable with the motor held, Hz.
  Estimate resonance;      ///< Frequency of motor and link against each other, Hz.

  /// Returns whether a frequency was measured: below the highest line, and to 5 %. Higher
  /// frequencies are computed from inertia and stiffness.
  static bool sees(const Estimate& frequency) {
    return frequency.value < LineForces::kHighest && frequency.plus_minus < 0.05 * frequency.value;
  }
};

/// Constants of a serial arm's links for an arm file (device_sim::LinkSettings), kg m^2 and kg m,
/// with their intervals.
struct LinkConstants {
  std::array<Estimate, 3> inertia;  ///< Inertia about A, B and C.
  Estimate yaw_b, yaw_c, coupling;
  Estimate moment_b, moment_c;
};

/// Constants of an arm for its file, with their intervals.
struct ArmConstants {
  Estimate mass;     ///< Mass at the tip, kg.
  Estimate viscous;  ///< N s/m
  Estimate coulomb;  ///< Dry friction, N per axis.
  Estimate weight;   ///< Weight at the tip, N.
  /// Ratio of the true torque to that of the arm file for each joint.
  std::array<Estimate, 3> gain;
  Estimate delay;  ///< Delay from the force to the motion that the host sees, s.
  /// The scale of masses and forces was measured with a known mass. If not, the gains' geometric
  /// mean was assumed to be 1, and all constants but the delay are relative to that.
  bool absolute = false;
  /// Motors and cables, if the cables were seen to stretch. Mass, friction and weight are then
  /// those of the links.
  std::optional<std::array<CableConstants, 3>> cables;
  /// Whether links were searched for in motion at several poses, and the links found. Mass,
  /// friction and weight are then those of the tip without links.
  bool links_sought = false;
  std::optional<LinkConstants> links;
  double misfit = 0;  ///< With a known mass: chi^2 per degree of freedom of both motions together.
};

/// Widens an interval by the error of a method beyond its statistics, given as one standard
/// deviation.
void widen(Estimate& estimate, double method);

/// Converts a torque in the arm file's constants (or the reciprocal of a torque) to the true one.
/// Real-time: never from the servo thread.
Estimate by_gain(const Estimate& torque, const Estimate& gain);

/// Returns the constants that follow from the motion of a bare tip, or from two motions, the second
/// with a known mass on the tip. The added mass slows the tip by its share of the mass, whatever
/// the motors' constants are. The error explains why no such arm exists. Real-time: never from the
/// servo thread.
driver::Result<ArmConstants> arm_constants(const MassNormalisedFit& bare,
                                           const Eigen::Vector3d& down_B,
                                           const std::optional<MassNormalisedFit>& loaded,
                                           double added_mass);

}  // namespace thimble::bringup
