#pragma once

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

namespace thimble::support {

/// Returns the file of a shipped scene.
inline std::filesystem::path scene_file(const std::string& name) {
  return std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes" / (name + ".yaml");
}

/// Returns the names of the shipped scenes whose bodies meet, sorted.
inline std::vector<std::string> scenes_of_bodies() {
  return {"blocks", "cans", "dominoes", "door", "drawer", "lever", "pendulum"};
}

/// Returns the names of all other shipped scenes, sorted, except `two_hands`, which needs several
/// arms and a separate run. `elephant` needs its scanned mesh.
inline std::vector<std::string> scenes_of_one_arm() {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(
           std::filesystem::path(THIMBLE_SOURCE_DIR) / "app/scenes")) {
    const std::string name = entry.path().stem().string();
    const std::vector<std::string> bodies = scenes_of_bodies();
    const bool meets = std::find(bodies.begin(), bodies.end(), name) != bodies.end();
    if (entry.path().extension() == ".yaml" && name != "two_hands" && !meets) names.push_back(name);
  }
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace thimble::support
