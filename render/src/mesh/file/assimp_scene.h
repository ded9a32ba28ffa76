#pragma once

#include <string>
#include <vector>

#include "thimble/driver/result.h"
#include "thimble/render/mesh/triangle_mesh.h"

struct aiScene;

namespace thimble::render {

/// Returns the triangles of a scene as Assimp holds it, each part as often and where its nodes put
/// it; mirrored parts are turned round, so that their outer side stays outside. What is left out
/// (bones, animations, lines and points) is added to `notes`. The error is a sentence.
/// Real-time: never from the servo thread.
driver::Result<TriangleMesh> mesh_of_scene(const aiScene& scene, std::vector<std::string>& notes);

}  // namespace thimble::render
