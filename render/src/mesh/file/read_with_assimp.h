#pragma once

#include <string>
#include <string_view>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Reads the bytes of an OBJ or STL file by the Assimp library. `ending` is "obj" or "stl". Not
/// welded. The error is a sentence without the file's name. Real-time: never from the
/// servo thread.
driver::Result<TriangleMesh> read_with_assimp(std::string_view bytes, const std::string& ending);

}  // namespace thimble::render
