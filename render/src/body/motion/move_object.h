#pragma once

#include <memory>

#include "thimble/driver/result.h"
#include "thimble/render/body/motion_choice.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// Lets an object move: wraps its force law, made for `mesh_W` (W, m; closed). The error says which
/// number a body cannot have, or that the mesh encloses no volume.
/// Real-time: never from the servo thread.
driver::Result<std::unique_ptr<ObjectTouch>> move_object(std::unique_ptr<ObjectTouch> surface,
                                                         const TriangleMesh& mesh_W,
                                                         const MotionChoice& choice,
                                                         const BodyCoupling& coupling);

}  // namespace thimble::render
