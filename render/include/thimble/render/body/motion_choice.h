#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>

#include "thimble/driver/export.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// Kind of motion of a whole object.
enum class MotionKind : std::uint8_t {
  kTranslate,  ///< Three degrees of freedom: all points follow one point mass [BP 4.3].
  kRigid,      ///< Six degrees of freedom, with the inertia of the homogeneous solid mesh.
};

/// Floor plane that keeps bodies out of n . x < height.
struct Floor {
  Eigen::Vector3d n_W{0, 0, 1};  ///< Unit normal, away from the floor.
  double height = 0;             ///< Height of the plane along the normal, m.
  double friction = 0.5;         ///< Coulomb friction coefficient, >= 0.
};

/// Grip of a hand on an object.
struct Grip {
  double stiffness = 500;  ///< Stiffness, N/m, > 0.
  double damping = 2;      ///< Damping, N s/m, >= 0.
  /// Largest force, N, > 0; under a larger one the object slips out of the hand permanently.
  double force_max = 4;
};

/// Shape by which an object collides with other bodies.
enum class CollisionShape : std::uint8_t {
  kOwn,     ///< That of a shape; the convex hull of a mesh that moves; a mesh that does not move.
  kHull,    ///< Convex hull.
  kBox,     ///< Smallest of three boxes around it: along its principal axes, its place, the world.
  kSphere,  ///< Sphere of the same volume around its centre of mass.
  kMesh,    ///< All triangles; slow if it moves.
  kPieces,  ///< Convex pieces, for a body with hollows.
  kNone,    ///< Does not collide.
};

/// Collisions of one object with bodies.
struct THIMBLE_EXPORT CollisionChoice {
  CollisionShape shape = CollisionShape::kOwn;  ///< Shape.
  double friction = 0.5;                        ///< Coulomb friction, >= 0; a pair has the
                                                ///< geometric mean.
  double restitution = 0;                       ///< Speed after an impact over that before, 0 to 1;
                                                ///< a pair has the larger one.
  std::size_t pieces = 16;                      ///< Largest number of convex pieces; kPieces only.

  /// Reads the settings from a scene. Real-time: never from the servo thread.
  void read(SettingsReader& reader);
};

/// Accuracy of collisions.
struct CollisionQuality {
  std::size_t iterations = 50;  ///< Iterations of the solver in each step, >= 1.
  std::size_t substeps = 1;     ///< Steps of the solver in each tick, >= 1.
  /// Ticks in each step of the solver, >= 1; 1 if there are substeps. Between two steps bodies move
  /// on to the solver's result.
  std::size_t every = 1;
};

/// Motion of one object. By default the object starts at rest at the place of its mesh.
struct THIMBLE_EXPORT MotionChoice {
  MotionKind kind = MotionKind::kTranslate;  ///< Kind of motion.
  double mass = 0.1;                         ///< Mass, kg, > 0; not used with a density.
  /// Density, kg/m^3, > 0; the mass is then that of the matter inside of the closed mesh.
  std::optional<double> density{};
  Eigen::Vector3d gravity_W{0, 0, 0};  ///< Gravity in the world, m/s^2.
  double damping = 0;                  ///< Damping of translation, N s/m, >= 0.
  /// Damping of rotation, N m s, >= 0; kRigid only.
  double angular_damping = 0;
  /// Ratio of the object's time to real time, > 0; a smaller ratio makes the object feel heavier.
  double time_scale = 1;
  std::optional<Floor> floor{};  ///< Floor, if there is one.
  /// Largest displacement of the centre, m, >= 0.
  double reach = std::numeric_limits<double>::infinity();
  Eigen::Vector3d v_W{0, 0, 0};  ///< Initial velocity, m/s.
  /// Initial angular velocity, rad/s; kRigid only.
  Eigen::Vector3d omega_W{0, 0, 0};
  /// Grip, if the hand holds the object from the first tick.
  std::optional<Grip> grip{};

  /// Reads the settings from a scene. Real-time: never from the servo thread.
  void read(SettingsReader& reader);
};

/// Upper bounds of the surface response to a moved body, over all stages; needed by the coupling.
struct BodyCoupling {
  /// Stiffness, N/m, >= 0: the larger of the surface's spring and the stiffness along the surface.
  double stiffness = 0;
  double damping = 0;  ///< Damping of the surface, N s/m, >= 0.
  double step = 1e-3;  ///< Period of the loop and of the body's motion, s, > 0.
};

}  // namespace thimble::render
