#include "yaml/yaml_settings.h"

#include <cstdint>
#include <system_error>

#include "files/scene_paths.h"

namespace thimble::scene {

void YamlSettings::number(std::string_view key, double& value, const render::NumberLimits& limits) {
  if (limits.whole) {
    const auto min = static_cast<std::int64_t>(limits.min);
    const auto max = static_cast<std::int64_t>(limits.max);
    value = static_cast<double>(
        limits.required
            ? map_.require_whole(key, limits.unit, min, max)
            : map_.optional_whole(key, static_cast<std::int64_t>(value), limits.unit, min, max));
    return;
  }
  value = limits.required ? map_.require_number(key, limits.unit, limits.min, limits.max)
                          : map_.optional_number(key, value, limits.unit, limits.min, limits.max);
}

void YamlSettings::vector(std::string_view key, Eigen::Vector3d& value,
                          const render::NumberLimits& limits) {
  value = limits.required ? map_.require_vector3(key, limits.unit, limits.min, limits.max)
                          : map_.optional_vector3(key, value, limits.unit, limits.min, limits.max);
}

void YamlSettings::choice(std::string_view key, std::size_t& value,
                          const std::vector<std::string_view>& names) {
  value = map_.optional_choice(key, value, names);
}

void YamlSettings::text(std::string_view key, std::string& value) {
  value = !key_.empty() && key == key_ ? text_ : map_.optional_string(key, value);
}

void YamlSettings::file(std::string_view key, std::filesystem::path& value) {
  const std::string name = map_.require_string(key);
  if (name.empty()) return;
  value = find_scene_file(folder_, name);
  map_.note_file(value);
  std::error_code status;
  if (!std::filesystem::is_regular_file(value, status)) {
    map_.refuse(key, "expected a file, found none at " + value.string());
  }
}

void YamlSettings::list(std::string_view key,
                        const std::function<void(render::SettingsReader&)>& read) {
  for (const YamlMap& entry : map_.require_maps(key)) {
    YamlSettings settings(entry, folder_);
    read(settings);
    settings.finish();
  }
}

void YamlSettings::reject(std::string_view key, const std::string& sentence) {
  map_.reject(key, sentence);
}

}  // namespace thimble::scene
