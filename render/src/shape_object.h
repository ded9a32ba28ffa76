#pragma once

#include <memory>

#include "thimble/driver/result.h"
#include "thimble/render/build_object_touch.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/render/object_touch.h"

namespace thimble::render {

/// Builds the force law of an object whose base points move by themselves (mesh in W, m), according
/// to `surface.shape`. The error is that of ContactMesh::build or BodyShape::build, or states that
/// the chosen contact cannot follow a surface that changes shape. Real-time: never from the servo
/// thread.
driver::Result<std::unique_ptr<ObjectTouch>> shaped_touch(const TriangleMesh& mesh_W,
                                                          const ContactChoice& contact,
                                                          const SurfaceChoice& surface);

}  // namespace thimble::render
