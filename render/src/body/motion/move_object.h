#pragma once

#include <memory>
#include <vector>

#include "body/motion/body_motions.h"
#include "body/motion/shared_body.h"
#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/body/motion_choice.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// Returns the mass of a body (kg): as given, or that of the matter inside of its mesh (W, m). The
/// error states that the mesh encloses no volume, or that the mass is out of range. Real-time:
/// never from the servo thread.
THIMBLE_EXPORT driver::Result<double> mass_of(const TriangleMesh& mesh_W,
                                              const MotionChoice& choice);

/// Makes an object movable: wraps its force law, made for `mesh_W` (W, m; closed). The error names
/// an invalid number, or states that the mesh encloses no volume. Real-time: never from the servo
/// thread.
THIMBLE_EXPORT driver::Result<std::unique_ptr<ObjectTouch>> move_object(
    std::unique_ptr<ObjectTouch> surface, const TriangleMesh& mesh_W, const MotionChoice& choice,
    const BodyCoupling& coupling);

/// Returns the motion of an object with six degrees of freedom, with its mass and first velocities,
/// for all kinds of motion. `axes_W` are those of a symmetric shape (prefer_axes); null for a mesh.
/// Errors and time: as `move_object`.
THIMBLE_EXPORT driver::Result<RigidMotion> rigid_motion_of(const TriangleMesh& mesh_W,
                                                           const MotionChoice& choice,
                                                           const Eigen::Matrix3d* axes_W = nullptr);

/// An object that several hands touch: one force law per hand, and the shared body.
struct SharedObject {
  std::vector<std::unique_ptr<ObjectTouch>> touches;  ///< One for each hand.
  std::shared_ptr<SharedBody> body;                   ///< Advanced by the code that runs the loop.
};

/// Makes one object movable by several hands: wraps its force laws, made for `mesh_W`, one for each
/// hand. Errors and time: as `move_object`.
THIMBLE_EXPORT driver::Result<SharedObject> move_shared_object(
    std::vector<std::unique_ptr<ObjectTouch>> surfaces, const TriangleMesh& mesh_W,
    const MotionChoice& choice, const BodyCoupling& coupling);

}  // namespace thimble::render
