#include "user_folders.h"

#include <cctype>
#include <cstdlib>

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

fs::path folder(const char* variable, const char* below_home) {
  const char* named = std::getenv(variable);
  if (named != nullptr && *named != 0) return fs::path(named) / "thimble";
  const char* home = std::getenv("HOME");
  return fs::path(home != nullptr ? home : "/") / below_home / "thimble";
}

}  // namespace

fs::path config_folder() {
  return folder("XDG_CONFIG_HOME", ".config");
}

fs::path state_folder() {
  return folder("XDG_STATE_HOME", ".local/state");
}

fs::path cache_folder() {
  return folder("XDG_CACHE_HOME", ".cache");
}

fs::path data_folder() {
  return folder("XDG_DATA_HOME", ".local/share");
}

fs::path own_arm_folder() {
  return config_folder() / "arm_files";
}

std::string as_file_name(const std::string& name) {
  std::string safe = name;
  for (char& c : safe) {
    const bool good = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '-' || c == '_';
    if (!good) c = '_';
  }
  return safe;
}

}  // namespace thimble::scene
