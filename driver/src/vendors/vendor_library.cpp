#include "vendors/vendor_library.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace thimble::driver {
namespace {

/// An open library.
struct Opened {
  void* handle;
  std::string file;
};

Result<Opened> open_first(std::span<const std::string> files) {
  std::string looked_for, refused;
  for (const std::string& file : files) {
    void* const handle = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
    if (handle != nullptr) return Opened{handle, file};
    const char* why = dlerror();
    looked_for += (looked_for.empty() ? "" : ", ") + file;
    std::error_code missing;
    // The file exists, or the linker reports another missing file for this name.
    const std::string text = why == nullptr ? "" : why;
    const bool there = std::filesystem::exists(file, missing) || !text.starts_with(file + ":");
    if (there && refused.empty()) refused = text;
  }
  if (!refused.empty()) return Error{"Cannot open the library: " + refused + "."};
  return Error{"None of these libraries was found: " + looked_for + "."};
}

}  // namespace

Result<std::string> open_vendor_library(std::span<const std::string> files,
                                        std::initializer_list<VendorFunction> functions,
                                        const std::string& otherwise) {
  auto opened = open_first(files);
  if (!opened) return opened.error();
  for (const VendorFunction& function : functions) {
    void* const found = dlsym(opened->handle, function.name());
    if (found == nullptr) {
      return Error{opened->file + " has no function " + function.name() + ", so it is not " +
                   otherwise};
    }
    function.put(found);
  }
  return opened->file;
}

std::vector<std::string> vendor_files(const char* name, std::vector<std::string> files) {
  const char* own = std::getenv(name);
  if (own != nullptr && *own != 0) return {own};
  return files;
}

}  // namespace thimble::driver
