#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace thimble::driver {

/// Says what a force law touched in one tick; for readers at the side (viewer, recorder, tests).
struct TouchInfo {
  bool in_contact = false;        ///< True while the tip is held outside an object.
  std::int16_t object = -1;       ///< Which of the scene's objects, -1 for none.
  std::int32_t feature = -1;      ///< Active triangle or other feature of the object, -1 for none.
  double depth = 0;               ///< Penetration depth along the force's normal, m; 0 if none.
  Eigen::Vector3d p_WP{0, 0, 0};  ///< Proxy: the surface point the tip is held at, in the world, m.
  Eigen::Vector3d n_W{0, 0, 0};   ///< Outward unit normal that the force acts along; 0 if none.
  std::uint16_t hops = 0;         ///< Features crossed in this tick.
};

/// Holds what a force law asks for in one tick. It is only a wish: nothing reaches the motors
/// except through SafetyGate.
struct ForceCommand {
  Eigen::Vector3d f_T_W{0, 0, 0};  ///< Force that the arm shall exert on the hand, in the world, N.
  TouchInfo touch;                 ///< What the force was made of.
};

}  // namespace thimble::driver
