#pragma once

#include <string>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Reads the bytes of a 3MF file in double precision, in a separate process [3MF core specification
/// 1.3, production extension 1.1]. Reads objects and components of all its models, each at the
/// place given by the build. The unit is that of the first model. A required extension with a shape
/// that is not read (beam lattices, slices, displacement ...) is refused by name; colours and
/// materials are omitted. Not welded. The error is a sentence without the file's name. Real-time:
/// never from the servo thread.
driver::Result<TriangleMesh> read_3mf(const std::string& bytes, MeshFileInfo& info);

}  // namespace thimble::render
