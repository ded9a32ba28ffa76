#include "vendors/vendor_library.h"

#include <dlfcn.h>

#include <filesystem>
#include <system_error>
#include <utility>

namespace thimble::driver {

Result<VendorLibrary> VendorLibrary::open(std::span<const std::string> files) {
  std::string looked_for, refused;
  for (const std::string& file : files) {
    void* const handle = dlopen(file.c_str(), RTLD_LAZY | RTLD_LOCAL | RTLD_NODELETE);
    if (handle != nullptr) return VendorLibrary(handle, file);
    const char* why = dlerror();
    looked_for += (looked_for.empty() ? "" : ", ") + file;
    std::error_code missing;
    // One that is there, or a name for which the linker misses something else.
    const std::string text = why == nullptr ? "" : why;
    const bool there = std::filesystem::exists(file, missing) || !text.starts_with(file + ":");
    if (there && refused.empty()) refused = text;
  }
  if (!refused.empty()) return Error{"The library cannot be opened: " + refused + "."};
  return Error{"None of these libraries is there: " + looked_for + "."};
}

void* VendorLibrary::address_of(const char* name) const {
  return dlsym(handle_, name);
}

}  // namespace thimble::driver
