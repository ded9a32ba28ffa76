#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "thimble/scene/scene_builder.h"

namespace thimble::scene {

/// Access to the parts of a value, for the writer of scenes. Real-time: never from the servo
/// thread.
struct SceneValue::Parts {
  static bool is_list(const SceneValue& value) { return value.kind_ == Kind::kList; }
  static bool is_map(const SceneValue& value) { return value.kind_ == Kind::kMap; }
  /// Returns the entries of a list, or the values of a map.
  static const std::vector<SceneValue>& values(const SceneValue& value) { return value.values_; }
  /// Returns the keys of a map.
  static const std::vector<std::string>& keys(const SceneValue& value) { return value.keys_; }

  /// Returns the text of a key; null if it has none.
  static const std::string* text_of(const SceneValue& map, std::string_view key);
  /// Returns a value in one line of YAML.
  static std::string in_line(const SceneValue& value);
  /// Returns a text as YAML: a word, or in double quotes [YAML 1.2, 7.3.1].
  static std::string in_yaml(const std::string& text);
  /// Replaces relative names of files in `folder` by absolute paths, also in lists and maps.
  static void make_paths_whole(SceneValue& value, const std::filesystem::path& folder);
};

}  // namespace thimble::scene
