#include "compat/server/library_folder.h"

#include <system_error>

namespace thimble::compat {

driver::Result<std::filesystem::path> library_folder() {
  std::error_code status;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", status);
  for (const char* place : {"compat/lib", THIMBLE_COMPAT_INSTALLED}) {
    std::filesystem::path folder = (program.parent_path() / place).lexically_normal();
    if (std::filesystem::exists(folder / "libHD.so", status)) return folder;
  }
  return driver::Error{
      "The compatibility libraries are not installed. Install the package "
      "thimble-compat (`sudo apt install thimble-compat`), or build the target "
      "thimble_compat_libraries."};
}

}  // namespace thimble::compat
