#include "files/scene_paths.h"

#include <string>
#include <string_view>
#include <system_error>
#include <utility>

#include "files/data_folders.h"
#include "files/scanned_meshes.h"
#include "thimble/scene/shipped_files.h"

namespace thimble::scene {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kMeshScheme = "cgal:";

bool is_file(const fs::path& path) {
  std::error_code status;
  return fs::is_regular_file(path, status);
}

}  // namespace

fs::path find_scene_file(const fs::path& folder, const std::string& name) {
  const fs::path path = (folder / name).lexically_normal();
  if (is_file(path) || name.find('/') != std::string::npos) return path;
  for (const fs::path& data : data_folders()) {
    if (is_file(data / "scenes" / name)) return data / "scenes" / name;
  }
  return path;
}

fs::path find_mesh_file(YamlMap& map, const fs::path& folder, const fs::path& mesh_folder) {
  const std::string text = map.require_string("mesh");
  if (text.empty()) return {};
  fs::path path;
  if (!text.starts_with(kMeshScheme)) {
    path = find_scene_file(folder, text);
  } else {
    const std::string name = text.substr(kMeshScheme.size());
    path = mesh_folder / name;
    if (mesh_folder.empty()) {
      auto found = find_scan(name);
      if (!found) {
        map.refuse("mesh", found.error().message);
        return {};
      }
      path = std::move(found).value();
    }
  }
  if (!is_file(path)) {
    map.refuse("mesh", "expected a file, found none at " + path.lexically_normal().string());
  }
  map.note_file(path.lexically_normal());
  return path.lexically_normal();
}

fs::path find_own_arm_file(YamlMap& map, const fs::path& folder) {
  const std::string text = map.require_string("arm");
  if (text.empty()) return {};
  const fs::path path = (folder / text).lexically_normal();
  if (is_file(path)) return path;
  std::string names;
  if (text.find('/') == std::string::npos) {
    for (const ShippedFile& arm : shipped_arms()) {
      if (text == arm.name || text == arm.name + ".yaml") return arm.path;
      names += (names.empty() ? "; or the name of an arm: " : ", ") + arm.name;
    }
  }
  map.refuse("arm", "expected a file, found none at " + path.string() + names);
  return path;
}

}  // namespace thimble::scene
