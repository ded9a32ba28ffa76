#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <limits>
#include <memory>
#include <optional>

#include "body/motion/body_coupling.h"
#include "body/motion/held_touch.h"
#include "body/motion/rigid_body.h"
#include "thimble/driver/result.h"
#include "thimble/render/effect/settings_reader.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// Says how an object moves as a whole.
enum class MotionKind : std::uint8_t {
  kTranslate,  ///< Three ways: all base points relative to one mass point [BP 4.3].
  kRigid,      ///< Six ways, with the inertia of the mesh evenly filled.
};

/// Sets the motion of one object. The object is at rest where its mesh stands unless said.
struct MotionChoice {
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

/// Lets an object move: wraps its force law, made for `mesh_W` (W, m; closed). The error says which
/// number a body cannot have, or that the mesh encloses no volume.
/// Real-time: never from the servo thread.
driver::Result<std::unique_ptr<ObjectTouch>> move_object(std::unique_ptr<ObjectTouch> surface,
                                                         const TriangleMesh& mesh_W,
                                                         const MotionChoice& choice,
                                                         const BodyCoupling& coupling);

}  // namespace thimble::render
