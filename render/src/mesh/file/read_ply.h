#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Reads a mesh from the bytes of a PLY file: text or binary of either byte order, with any further
/// properties and faces of any size. Triangle strips are refused. `notes` gets a sentence if single
/// precision of a binary file is coarse. The error states the problem, without the file's name.
/// Memory grows with the bytes, not with the counts in the header. (Assimp 5.2.5 crashes on damaged
/// files of this format.) If `attributes` is not null, it gets texture coordinates and colours of
/// vertices; invalid ones are an error. Real-time: never from the servo thread.
driver::Result<TriangleMesh> read_ply(std::string_view bytes, std::vector<std::string>& notes,
                                      MeshAttributes* attributes = nullptr);

}  // namespace thimble::render
