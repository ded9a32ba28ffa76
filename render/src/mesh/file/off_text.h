#pragma once

#include <string>

#include "thimble/driver/export.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Returns a mesh as the text of an OFF file with 17 digits per coordinate.
/// Real-time: never from the servo thread.
THIMBLE_EXPORT std::string off_text(const TriangleMesh& mesh);

}  // namespace thimble::render
