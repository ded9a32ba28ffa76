// Replaces the Assimp reader in a build without the library.
#include "mesh/file/read_with_assimp.h"

namespace thimble::render {
namespace {

driver::Error absent(const std::string& ending) {
  return driver::Error{"this build cannot read ." + ending +
                       " meshes. Save the mesh as OFF, OBJ, PLY, STL or glTF 2, or configure with "
                       "-D THIMBLE_MESH_FORMATS=ON."};
}

}  // namespace

driver::Result<TriangleMesh> read_with_assimp(const std::string&, const std::string& ending,
                                              MeshFileInfo&) {
  return absent(ending);
}

driver::Result<TriangleMesh> import_by_assimp(const std::string&, const std::string& ending,
                                              const std::filesystem::path&,
                                              std::vector<std::string>&) {
  return absent(ending + " (version 1)");
}

}  // namespace thimble::render
