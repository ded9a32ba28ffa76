#include "files/data_folders.h"

#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <string>
#include <string_view>
#include <system_error>

#include "user_folders.h"

// Returns the folder of the files that were installed with the libraries. The CMake package defines
// it in each program that is built with them (app/install/installed_files.cpp.in), because a static
// library does not know its own place.
extern "C" __attribute__((weak)) const char* thimble_installed_files();

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

/// Returns whether a file name is that of a shared library: module.so, libname.so.0.3.0.
bool is_shared_library(const fs::path& file) {
  const std::string name = file.filename();
  return name.ends_with(".so") || name.find(".so.") != std::string::npos;
}

/// Returns the path of the program, or of the shared library that contains this code (the Python
/// module, a shared build).
fs::path own_file() {
  std::error_code status;
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&own_file), &info) != 0 && info.dli_fname != nullptr) {
    fs::path file = fs::canonical(info.dli_fname, status);
    // For a program, dli_fname is the name of the call, without a folder if the shell searched
    // $PATH.
    if (!status && is_shared_library(file)) return file;
  }
  return fs::read_symlink("/proc/self/exe", status);
}

bool has_both(const fs::path& folder) {
  std::error_code status;
  return fs::is_directory(folder / "scenes", status) && fs::is_directory(folder / "arms", status);
}

}  // namespace

fs::path own_folder() {
  for (fs::path above = own_file().parent_path();; above = above.parent_path()) {
    for (const fs::path& folder : {above / "share" / "thimble", above / "app"}) {
      if (has_both(folder)) return folder;
    }
    if (!above.has_relative_path()) break;
  }
  const char* reported = thimble_installed_files != nullptr ? thimble_installed_files() : "";
  for (const fs::path& folder : {fs::path(reported), fs::path(THIMBLE_INSTALLED_FILES)}) {
    if (!folder.empty() && has_both(folder)) return folder;
  }
  return {};
}

std::vector<fs::path> data_folders() {
  // The working folder is never searched: its files may come from an untrusted source, and arm
  // files set the limits of arms.
  std::vector<fs::path> folders{data_folder(), own_folder()};
  const char* named = std::getenv("XDG_DATA_DIRS");
  std::string_view rest = named != nullptr && *named != 0 ? named : "/usr/local/share:/usr/share";
  while (!rest.empty()) {
    const std::string_view one = rest.substr(0, rest.find(':'));
    // Relative paths are ignored [XDG Base Directory Specification].
    if (fs::path(one).is_absolute()) folders.push_back(fs::path(one) / "thimble");
    rest.remove_prefix(std::min(rest.size(), one.size() + 1));
  }
  return folders;
}

}  // namespace thimble::scene
