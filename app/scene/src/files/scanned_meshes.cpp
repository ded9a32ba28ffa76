#include "files/scanned_meshes.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <system_error>

#include "files/data_folders.h"
#include "user_folders.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

constexpr const char* kArchive = "/usr/share/doc/libcgal-dev/data.tar.gz";
constexpr const char* kInArchive = "data/meshes";

bool is_there(const fs::path& path) {
  std::error_code status;
  return fs::is_regular_file(path, status);
}

/// Runs tar on an archive without output. Returns whether it succeeded.
bool untar(const fs::path& archive, const fs::path& folder) {
  posix_spawn_file_actions_t actions;
  if (posix_spawn_file_actions_init(&actions) != 0) return false;
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO}) {
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  }
  std::array<std::string, 6> words{"tar", "-xzf",          archive.string(),
                                   "-C",  folder.string(), kInArchive};
  std::array<char*, 7> arguments{};
  std::transform(words.begin(), words.end(), arguments.begin(),
                 [](std::string& word) { return word.data(); });
  pid_t child = 0;
  const int failure = posix_spawnp(&child, "tar", &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) return false;
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return false;
  }
  return WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

/// Unpacks the meshes of the archive to `unpacked`, completely or not at all: into a folder next to
/// it first, which is then renamed.
driver::Result<void> unpack(const fs::path& archive, const fs::path& unpacked) {
  std::error_code failed;
  fs::create_directories(unpacked.parent_path(), failed);
  std::string work = unpacked.string() + ".XXXXXX";
  if (failed || mkdtemp(work.data()) == nullptr) {
    return driver::Error{fmt::format(
        "Cannot unpack the scanned meshes to {}: {}. Set XDG_CACHE_HOME to a writable folder.",
        unpacked.string(), failed ? failed.message() : std::strerror(errno))};
  }
  const bool untarred = untar(archive, work);
  if (untarred) fs::rename(fs::path(work) / kInArchive, unpacked, failed);
  std::error_code ignored;
  fs::remove_all(work, ignored);
  // Another run may have unpacked them at the same time.
  if ((untarred && !failed) || fs::is_directory(unpacked, ignored)) return {};
  return driver::Error{
      fmt::format("Cannot unpack the scanned meshes in {} to {}. Check that the disk is not full "
                  "and that tar is "
                  "installed, or unpack {} yourself and set THIMBLE_MESHES to that folder.",
                  archive.string(), unpacked.string(), kInArchive)};
}

}  // namespace

ScanPlaces scan_places() {
  if (const char* chosen = std::getenv("THIMBLE_MESHES"); chosen != nullptr && *chosen != 0) {
    return {.folders = {chosen}, .archive = {}, .unpacked = {}};
  }
  ScanPlaces places{.folders = {}, .archive = kArchive, .unpacked = cache_folder() / "meshes"};
  const auto add = [&places](const fs::path& folder) {
    if (std::find(places.folders.begin(), places.folders.end(), folder) == places.folders.end()) {
      places.folders.push_back(folder);
    }
  };
  for (const fs::path& folder : data_folders()) {
    if (folder.empty()) continue;
    if (folder.filename() == "app") add(folder.parent_path() / "build" / "meshes");
    add(folder / "meshes");
  }
  return places;
}

driver::Result<fs::path> find_scan(const std::string& name, const ScanPlaces& places) {
  std::string looked;
  for (const fs::path& folder : places.folders) {
    if (is_there(folder / name)) return folder / name;
    looked += (looked.empty() ? "" : ", ") + folder.string();
  }
  if (!places.unpacked.empty()) {
    std::error_code status;
    if (!fs::is_directory(places.unpacked, status) && is_there(places.archive)) {
      if (auto done = unpack(places.archive, places.unpacked); !done) return done.error();
    }
    if (is_there(places.unpacked / name)) return places.unpacked / name;
    looked += (looked.empty() ? "" : ", ") + places.unpacked.string();
  }
  return driver::Error{fmt::format(
      "{} is a scan of Debian's package libcgal-demo, and is not in {}. Install it (sudo apt "
      "install libcgal-demo), run app/fetch_meshes.sh in the sources, or set THIMBLE_MESHES to a "
      "folder with it; `thimble run water_balloon` uses a mesh that comes with Thimble",
      name, looked)};
}

}  // namespace thimble::scene
