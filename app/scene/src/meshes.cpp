#include "thimble/scene/meshes.h"

#include <cstdlib>

namespace thimble::scene {

std::filesystem::path mesh_folder() {
  const char* chosen = std::getenv("THIMBLE_MESHES");
  return chosen && *chosen ? chosen : THIMBLE_MESH_FOLDER;
}

}  // namespace thimble::scene
