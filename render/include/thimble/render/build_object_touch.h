#pragma once

#include <memory>

#include "thimble/driver/result.h"
#include "thimble/render/contact_choice.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/render/object_touch.h"
#include "thimble/render/surface/spring_damper.h"

namespace thimble::render {

/// Builds the force law of one object (mesh in W, m) from just the stages that `choice` names. The
/// error is that of ContactMesh::build, or says which stages do not go together.
/// Real-time: never from the servo thread.
driver::Result<std::unique_ptr<ObjectTouch>> build_object_touch(const TriangleMesh& mesh_W,
                                                                const ContactChoice& choice,
                                                                const SpringDamper& surface);

}  // namespace thimble::render
