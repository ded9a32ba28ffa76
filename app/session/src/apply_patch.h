#pragma once

#include "thimble/driver/export.h"
#include "thimble/render/body_patch.h"
#include "thimble/render/mesh/triangle_mesh.h"
#include "thimble/scene/scene_objects.h"

namespace thimble::session {

/// Returns a mesh (m) in which the patch replaces its triangles of the object that begins at
/// `place`. Real-time: never from the servo thread.
THIMBLE_EXPORT render::TriangleMesh apply_patch(const render::TriangleMesh& mesh,
                                                const scene::MeshPlace& place,
                                                const render::BodyPatch& patch);

}  // namespace thimble::session
