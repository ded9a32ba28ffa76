#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Reads the bytes of a mesh file by the Assimp library, in a separate process. `ending` is its
/// kind: dae, amf (packed or not) or 3ds. Each part is at its place in the file. Information of the
/// file is added to `info`, also if single precision is coarse. Not welded. The error is a sentence
/// without the file's name. Real-time: never from the servo thread.
driver::Result<TriangleMesh> read_with_assimp(const std::string& bytes, const std::string& ending,
                                              MeshFileInfo& info);

/// Does the same in the calling process, without unit and axes; call it only in a process made by
/// read_in_child. `ending` may be gltf or glb, of version 1; then `folder` is the file's folder,
/// from which it may use other files.
driver::Result<TriangleMesh> import_by_assimp(const std::string& bytes, const std::string& ending,
                                              const std::filesystem::path& folder,
                                              std::vector<std::string>& notes);

}  // namespace thimble::render
