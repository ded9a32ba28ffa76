// The Assimp readers for programs whose package does not depend on that library. They are in the
// module thimble-mesh-formats.so, which is loaded at the first use. This is linked before
// thimble_render and replaces its readers.
#include <dlfcn.h>
#include <pthread.h>

#include <cstring>
#include <filesystem>
#include <mutex>
#include <string>
#include <vector>

#include "cli/parts/mesh_formats.h"
#include "cli/parts/part.h"
#include "thimble/version.h"

namespace thimble::render {
namespace {

// Held while the module is loaded, so that no process is forked meanwhile: a child that reads a
// mesh would wait forever for the loader's lock.
std::mutex loading;
[[maybe_unused]] const int held_by_fork =
    pthread_atfork([] { loading.lock(); }, [] { loading.unlock(); }, [] { loading.unlock(); });

driver::Result<const cli::MeshFormats*> load_formats(const std::string& ending) {
  const auto file = cli::find_beside_program(cli::kMeshFormatsFile,
                                             {".", THIMBLE_MODULES, THIMBLE_MODULES_OF_PARTS});
  if (file.empty()) {
    return driver::Error{
        "." + ending +
        " meshes require the package thimble-mesh-formats. Run `sudo apt install "
        "thimble-mesh-formats`, or save the mesh as OFF, OBJ, PLY, STL or glTF 2."};
  }
  const std::lock_guard<std::mutex> lock(loading);
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) {
    return driver::Error{file.string() + " cannot be loaded: " + dlerror() +
                         ". Reinstall the package thimble-mesh-formats."};
  }
  // Never unloaded: its functions may be called again.
  const auto* formats =
      static_cast<const cli::MeshFormats*>(dlsym(module, cli::kMeshFormatsSymbol));
  if (formats == nullptr || std::strcmp(formats->version, THIMBLE_VERSION) != 0) {
    return driver::Error{file.string() +
                         " belongs to another version of Thimble. Install the same version of the "
                         "packages thimble and thimble-mesh-formats."};
  }
  return formats;
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
