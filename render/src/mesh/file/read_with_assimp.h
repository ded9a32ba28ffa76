#pragma once

#include <filesystem>
#include <string>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Reads the bytes of a mesh file by the Assimp library, in a process of its own. `ending` is that
/// of the file's name in small letters: obj, stl, gltf, glb, 3mf, dae, amf or 3ds; `folder` is
/// where the file lies: a glTF file may name others there. Each part stands where the file puts it.
/// What the file says of itself is added to `info`. Not welded. The error is a sentence without
/// the file's name. Real-time: never from the servo thread.
driver::Result<TriangleMesh> read_with_assimp(const std::string& bytes, const std::string& ending,
                                              const std::filesystem::path& folder,
                                              MeshFileInfo& info);

}  // namespace thimble::render
