#include "cli/parts/load_module.h"

#include <dlfcn.h>
#include <pthread.h>

#include <cstring>
#include <mutex>

#include "cli/parts/part.h"
#include "thimble/version.h"

namespace thimble::cli {
namespace {

// Held while a module is loaded, so that no process is forked meanwhile: a child that reads a mesh
// would wait forever for the loader's lock.
std::mutex loading;
[[maybe_unused]] const int held_by_fork =
    pthread_atfork([] { loading.lock(); }, [] { loading.unlock(); }, [] { loading.unlock(); });

}  // namespace

driver::Result<const void*> load_module(const ModulePart& part, const std::string& absent) {
  const auto file =
      find_beside_program(part.file, {".", THIMBLE_MODULES, THIMBLE_MODULES_OF_PARTS});
  if (file.empty()) return driver::Error{absent};
  const std::lock_guard<std::mutex> lock(loading);
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) {
    return driver::Error{file.string() + " cannot be loaded: " + dlerror() +
                         ". Reinstall the package " + part.package + "."};
  }
  // Never unloaded: its functions may be called again.
  const void* const found = dlsym(module, part.symbol);
  const char* const version = found != nullptr ? *static_cast<const char* const*>(found) : "";
  if (std::strcmp(version, THIMBLE_VERSION) != 0) {
    return driver::Error{file.string() +
                         " belongs to another version of Thimble. Install the same version of the "
                         "packages thimble and " +
                         part.package + "."};
  }
  return found;
}

}  // namespace thimble::cli
