#pragma once

#include <filesystem>

namespace thimble::scene {

/// Tells where the meshes of Debian's libcgal-demo lie (`cgal:` in scenes): the environment's
/// THIMBLE_MESHES, or the folder that this build was configured with.
std::filesystem::path mesh_folder();

}  // namespace thimble::scene
