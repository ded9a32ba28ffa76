#pragma once

#include <Eigen/Core>

namespace thimble::render {

/// What an effect may know of the arm, the loop and the surface it is put on, to choose its
/// defaults and to refuse what cannot be stable. All of it is fixed before the first tick.
struct EffectContext {
  double tick = 0.001;           ///< Period of the loop, s.
  double delay = 0;              ///< From encoder to force beyond the period, s.
  double encoder_step = 0;       ///< Longest step of the tip along one axis, m; 0 if ideal.
  double force_max = 0;          ///< What the gate lets pass, N.
  double tip_mass = 0;           ///< Least apparent mass of arm at the tip, kg; 0 if not known.
  double tip_damping = 0;        ///< Least viscous damping of the arm at the tip, N s/m.
  double tip_coulomb = 0;        ///< Least dry friction of the arm at the tip, N; 0 if not known.
  double surface_stiffness = 0;  ///< Of the object, N/m.
  double surface_damping = 0;    ///< Of the object, N s/m.
  Eigen::Matrix3d R_WO = Eigen::Matrix3d::Identity();  ///< How the object stands in the world.
  Eigen::Vector3d p_WO{0, 0, 0};                       ///< Where the object stands, m.
};

}  // namespace thimble::render
