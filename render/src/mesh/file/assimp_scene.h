#pragma once

#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

struct aiScene;

namespace thimble::render {

/// Returns the triangles of an Assimp scene, each part at each place where its nodes put it.
/// Mirrored parts are turned, so that their outer side stays outside. Omitted data (bones,
/// animations, lines and points) is added to `notes`. The error is a sentence. Real-time: never
/// from the servo thread.
driver::Result<TriangleMesh> mesh_of_scene(const aiScene& scene, std::vector<std::string>& notes);

}  // namespace thimble::render
