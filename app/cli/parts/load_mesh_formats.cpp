// The Assimp readers for programs whose package does not depend on that library. They are in the
// module thimble-mesh-formats.so, which is loaded at the first use. This is linked before
// thimble_render and replaces its readers.
#include <filesystem>
#include <string>
#include <vector>

#include "cli/parts/load_module.h"
#include "cli/parts/mesh_formats.h"

namespace thimble::render {
namespace {

driver::Result<const cli::MeshFormats*> load_formats(const std::string& ending) {
  const auto formats = cli::load_module(
      {cli::kMeshFormatsFile, cli::kMeshFormatsSymbol, "thimble-mesh-formats"},
      "." + ending +
          " meshes require the package thimble-mesh-formats. Run `sudo apt install "
          "thimble-mesh-formats`, or save the mesh as OFF, OBJ, PLY, STL or glTF 2.");
  if (!formats) return formats.error();
  return static_cast<const cli::MeshFormats*>(*formats);
}

}  // namespace

driver::Result<TriangleMesh> read_with_assimp(const std::string& bytes, const std::string& ending,
                                              MeshFileInfo& info) {
  const auto formats = load_formats(ending);
  if (!formats) return formats.error();
  return (*formats)->read(bytes, ending, info);
}

driver::Result<TriangleMesh> import_by_assimp(const std::string& bytes, const std::string& ending,
                                              const std::filesystem::path& folder,
                                              std::vector<std::string>& notes) {
  const auto formats = load_formats(ending);
  if (!formats) return formats.error();
  return (*formats)->import(bytes, ending, folder, notes);
}

}  // namespace thimble::render
