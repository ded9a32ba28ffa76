#pragma once

#include <filesystem>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Reads a mesh from an OFF, OBJ, STL or PLY file (told by its name's ending), splits polygons into
/// triangles and welds vertices that lie at exactly the same place (STL has no other way to share
/// them). Coordinates stay in the file's unit; OFF and PLY keep what
/// precision the file has, OBJ and STL are read in single precision.
///
/// The error names the file and, for OFF, the line: no such file, unknown ending, truncated, no
/// triangles, a coordinate that is not a finite number or beyond 1e15, an index out of range.
/// Memory grows with the file's size, not with the counts it promises. Real-time: never from the
/// servo thread.
driver::Result<TriangleMesh> load_mesh(const std::filesystem::path& file);

}  // namespace thimble::render
