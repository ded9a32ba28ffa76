#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/driver/result.h"
#include "thimble/render/mesh/mesh_file.h"
#include "thimble/render/mesh/triangle_mesh.h"

namespace thimble::render {

/// Reads the bytes of a glTF or GLB file of version 2 in a separate process [Khronos, glTF 2.0].
/// `kind` is gltf or glb; `folder` is the file's folder, from which the file may use plain files
/// there and below. Nodes, instances (EXT_mesh_gpu_instancing), quantized and sparse positions and
/// the weights of morph targets are read; bones, animations, lines and points are omitted and
/// reported. An unknown required extension is refused by name. Files of version 1 are read by
/// Assimp. Not welded. If `attributes` is not null, it gets TEXCOORD_0 and COLOR_0; those of
/// version 1 are not read. The error is a sentence without the file's name. Real-time: never from
/// the servo thread.
driver::Result<TriangleMesh> read_gltf(const std::string& bytes, const std::string& kind,
                                       const std::filesystem::path& folder, MeshFileInfo& info,
                                       MeshAttributes* attributes = nullptr);

/// Returns the files in its folder that a glTF or GLB file names as its buffers; empty for any
/// other file. Files that do not exist are omitted. Real-time: never from the servo thread.
THIMBLE_EXPORT std::vector<std::filesystem::path> gltf_buffer_files(
    const std::filesystem::path& file);

}  // namespace thimble::render
