#pragma once

#include <Eigen/Core>

namespace thimble::render {

/// Properties of the arm, the loop and the surface of an effect. An effect uses them to choose
/// defaults and to reject unstable settings. All are constant from before the first tick.
struct EffectContext {
  double tick = 0.001;  ///< Period of the loop, s.
  /// Delay from encoder to force in addition to the period, s.
  double delay = 0;
  /// Largest step of the tip along one axis, m; 0 if ideal.
  double encoder_step = 0;
  double force_max = 0;  ///< Force limit of the gate, N.
  /// Smallest apparent mass of the arm at the tip, kg; 0: unknown.
  double tip_mass = 0;
  /// Smallest viscous damping of the arm at the tip, N s/m.
  double tip_damping = 0;
  /// Smallest dry friction of the arm at the tip, N; 0: unknown.
  double tip_coulomb = 0;
  double surface_stiffness = 0;                        ///< Stiffness of the object's surface, N/m.
  double surface_damping = 0;                          ///< Damping of the object's surface, N s/m.
  Eigen::Matrix3d R_WO = Eigen::Matrix3d::Identity();  ///< Rotation of the object in the world.
  Eigen::Vector3d p_WO{0, 0, 0};                       ///< Position of the object in the world, m.
};

}  // namespace thimble::render
