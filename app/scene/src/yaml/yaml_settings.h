#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "thimble/render/effect/settings_reader.h"
#include "yaml/yaml_reader.h"

namespace thimble::scene {

/// SettingsReader that reads a map of a scene file; files are relative to `folder`. Real-time:
/// never from the servo thread.
class YamlSettings final : public render::SettingsReader {
 public:
  YamlSettings(YamlMap map, std::filesystem::path folder)
      : map_(std::move(map)), folder_(std::move(folder)) {}
  /// As above, with a text that was read before: the value of the key `key`.
  YamlSettings(YamlMap map, std::filesystem::path folder, std::string_view key, std::string text)
      : map_(std::move(map)), folder_(std::move(folder)), key_(key), text_(std::move(text)) {}

  bool has(std::string_view key) override { return map_.has(key); }
  void number(std::string_view key, double& value, const render::NumberLimits& limits) override;
  void vector(std::string_view key, Eigen::Vector3d& value,
              const render::NumberLimits& limits) override;
  void choice(std::string_view key, std::size_t& value,
              const std::vector<std::string_view>& names) override;
  void text(std::string_view key, std::string& value) override;
  void file(std::string_view key, std::filesystem::path& value) override;
  void list(std::string_view key,
            const std::function<void(render::SettingsReader&)>& read) override;
  void reject(std::string_view key, const std::string& sentence) override;
  void explain_unused(std::string_view key, const std::string& sentence) override {
    map_.explain_unused(key, sentence);
  }

  /// Records each key that was not requested as a mistake.
  void finish() { map_.finish(); }

 private:
  YamlMap map_;
  std::filesystem::path folder_;
  std::string key_, text_;
};

}  // namespace thimble::scene
