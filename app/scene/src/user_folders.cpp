#include "user_folders.h"

#include <pwd.h>
#include <unistd.h>

#include <array>
#include <cctype>
#include <cstdlib>

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

// Home folder of a user without one. No folder can be created in it, so each write fails with a
// message that contains this path.
constexpr const char* kNoHome = "/dev/null/HOME-is-not-set";

/// Returns the folder that an environment variable names. Empty if the variable is not set or names
/// a relative path, which counts as not set [XDG Base Directory Specification].
fs::path named_by(const char* variable) {
  const char* named = std::getenv(variable);
  const fs::path folder = named != nullptr ? named : "";
  return folder.is_absolute() ? folder : fs::path();
}

/// Returns the user's home folder: $HOME, or else the entry of the user database.
fs::path home() {
  if (fs::path named = named_by("HOME"); !named.empty()) return named;
  std::array<char, 16'384> texts{};
  passwd user{};
  passwd* found = nullptr;
  if (getpwuid_r(geteuid(), &user, texts.data(), texts.size(), &found) == 0 && found != nullptr &&
      found->pw_dir != nullptr && fs::path(found->pw_dir).is_absolute() &&
      fs::path(found->pw_dir) != "/") {
    return found->pw_dir;
  }
  return kNoHome;
}

fs::path folder(const char* variable, const char* below_home) {
  const fs::path named = named_by(variable);
  return (named.empty() ? home() / below_home : named) / "thimble";
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
