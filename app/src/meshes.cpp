#include "meshes.h"

#include <cstdlib>

namespace thimble::app {

std::filesystem::path mesh_folder() {
  const char* chosen = std::getenv("THIMBLE_MESHES");
  return chosen && *chosen ? chosen : THIMBLE_MESH_FOLDER;
}

}  // namespace thimble::app
