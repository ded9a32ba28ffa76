#include "thimble/scene/shipped_files.h"

#include <map>
#include <string_view>
#include <system_error>

#include "files/data_folders.h"
#include "text/nearest_word.h"
#include "text_file.h"
#include "user_folders.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

/// Returns the folders of arm files that set the limits of a real arm, in order of precedence.
std::vector<fs::path> installed_arm_folders() {
  std::vector<fs::path> folders{own_arm_folder()};
  if (const fs::path own = own_folder(); !own.empty()) folders.push_back(own / "arms");
  return folders;
}

/// Lists the files in folders. Of several files with one name, the first is listed.
std::vector<ShippedFile> list_in(const std::vector<fs::path>& folders) {
  std::map<std::string, fs::path> found;
  for (const fs::path& folder : folders) {
    std::error_code status, missing;
    for (fs::directory_iterator entry(folder, status), end; !status && entry != end;
         entry.increment(status)) {
      // Folders are skipped, and pipes, because reading a pipe would block.
      if (entry->path().extension() == ".yaml" && entry->is_regular_file(missing)) {
        found.try_emplace(entry->path().stem().string(), entry->path());
      }
    }
  }
  std::vector<ShippedFile> files;
  files.reserve(found.size());
  for (const auto& [name, path] : found) files.push_back({name, path});
  return files;
}

std::vector<ShippedFile> list(std::string_view kind) {
  std::vector<fs::path> places;
  if (kind == "arms") places.push_back(own_arm_folder());
  for (const fs::path& folder : data_folders()) {
    if (!folder.empty()) places.push_back(folder / kind);
  }
  return list_in(places);
}

driver::Result<fs::path> find(const std::string& meant, const char* kind, const char* noun) {
  if (meant.empty()) {
    return driver::Error{
        "The name is empty; give a file, or a name that `thimble run --list` prints."};
  }
  std::error_code status;
  const bool there = fs::exists(meant, status) && !fs::is_directory(meant, status);
  // A word without slash or extension is a name first, and then a file in the working folder.
  const bool is_path =
      meant.find('/') != std::string::npos || (there && !fs::path(meant).extension().empty());
  if (is_path) return fs::path(meant);
  const auto files = list(kind);
  std::string names;
  std::vector<std::string> known;
  for (const ShippedFile& file : files) {
    if (meant == file.name || meant == file.name + ".yaml") return file.path;
    names += (names.empty() ? "" : ", ") + file.name;
    known.push_back(file.name);
  }
  if (there) return fs::path(meant);
  const auto near = nearest_word(meant, known);
  return driver::Error{
      meant + ": there is no such file, and no " + noun + " with this name. " +
      (near ? "Did you mean " + *near + "? " : "") +
      (names.empty()
           ? "No names are known here; give the path of a file, or set XDG_DATA_DIRS to the "
             "folder that contains thimble/ with its scenes and arms."
           : "Known by name: " + names + ". `thimble run --list` prints details.")};
}

}  // namespace

std::vector<ShippedFile> shipped_scenes() {
  return list("scenes");
}

std::vector<ShippedFile> shipped_arms() {
  return list("arms");
}

std::vector<ShippedFile> installed_arms() {
  return list_in(installed_arm_folders());
}

bool is_installed_arm(const fs::path& file) {
  for (const ShippedFile& installed : installed_arms()) {
    std::error_code missing;
    if (installed.path.filename() == file.filename() &&
        fs::equivalent(installed.path.parent_path(), fs::absolute(file).parent_path(), missing)) {
      return true;
    }
  }
  return false;
}

std::string description_of(const fs::path& file) {
  auto yaml = YamlFile::load(file);
  // `thimble run` reports the mistakes of a file.
  return yaml ? yaml->root().optional_string("description", "") : std::string();
}

driver::Result<fs::path> find_scene(const std::string& meant) {
  return find(meant, "scenes", "scene");
}

driver::Result<fs::path> find_arm_file(const std::string& meant) {
  return find(meant, "arms", "arm file");
}

}  // namespace thimble::scene
