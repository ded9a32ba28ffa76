#pragma once

#include <string_view>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Reads a mesh out of the bytes of a PLY file: text or binary of either byte order, any numbers of
/// any further properties, faces of any size. The error says what is wrong, without the file's
/// name. Memory grows with the bytes, not with the counts they promise. (Assimp 5.2.5, which reads
/// the other formats, crashes on damaged ones of this.) Real-time: never from the servo thread.
driver::Result<TriangleMesh> read_ply(std::string_view bytes);

}  // namespace thimble::render
