#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <optional>

#include "thimble/driver/export.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// How an object moves as a whole.
enum class MotionKind : std::uint8_t {
  kTranslate,  ///< Three ways: all base points relative to one mass point [BP 4.3].
  kRigid,      ///< Six ways, with the inertia of the mesh evenly filled.
};

/// A plane that bodies lie on: they are held out of n . x < height.
struct Floor {
  Eigen::Vector3d n_W{0, 0, 1};  ///< Unit, away from the floor.
  double height = 0;             ///< m
  double friction = 0.5;         ///< Coulomb, >= 0
};

/// How a hand holds an object.
struct Grip {
  double stiffness = 500;  ///< N/m, > 0
  double damping = 2;      ///< N s/m, >= 0
  double force_max = 4;    ///< N, > 0: what pulls harder slips out of the hand, for good
};

/// The motion of one object. The object is at rest where its mesh stands unless said.
struct THIMBLE_EXPORT MotionChoice {
  MotionKind kind = MotionKind::kTranslate;                ///< How it moves.
  double mass = 0.1;                                       ///< kg, > 0
  Eigen::Vector3d gravity_W{0, 0, 0};                      ///< m/s^2
  double damping = 0;                                      ///< N s/m, >= 0
  double angular_damping = 0;                              ///< N m s, >= 0; rigid alone
  double time_scale = 1;                                   ///< > 0; see RigidBodySettings
  std::optional<Floor> floor{};                            ///< Where it cannot go below.
  double reach = std::numeric_limits<double>::infinity();  ///< m, >= 0: how far its centre may go
  Eigen::Vector3d v_W{0, 0, 0};                            ///< m/s, at first
  Eigen::Vector3d omega_W{0, 0, 0};                        ///< rad/s, at first; rigid alone
  std::optional<Grip> grip{};  ///< The hand holds it from the first tick.

  /// Reads the settings of a scene. Real-time: never from the servo thread.
  void read(SettingsReader& reader);
};

/// How stiff a surface answers a moved body at most, whatever its stages are: what the coupling
/// needs to know of them.
struct BodyCoupling {
  /// N/m, >= 0: the largest of the surface's spring and of what holds along it.
  double stiffness = 0;
  double damping = 0;  ///< N s/m, >= 0: the surface's
  double step = 1e-3;  ///< s, > 0: the loop's period, by which the body moves on in each tick
};

}  // namespace thimble::render
