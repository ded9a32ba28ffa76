#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// Answers an effect's questions from values in code, for programs and tests that need no scene,
/// and keeps its complaints. Vectors, files and lists cannot be given. Real-time: never from the
/// servo thread.
class THIMBLE_EXPORT MapSettings final : public SettingsReader {
 public:
  MapSettings() = default;
  /// Takes numbers (SI) and words by their keys.
  explicit MapSettings(std::map<std::string, double> numbers,
                       std::map<std::string, std::string> words = {})
      : numbers_(std::move(numbers)), words_(std::move(words)) {}

  bool has(std::string_view key) override {
    return numbers_.contains(std::string(key)) || words_.contains(std::string(key));
  }
  void number(std::string_view key, double& value, const NumberLimits& limits) override {
    const auto given = numbers_.find(std::string(key));
    if (given == numbers_.end()) {
      if (limits.required) reject(key, "is missing");
      return;
    }
    // Written so that NaN is refused.
    if (!(given->second >= limits.least && given->second <= limits.most)) {
      reject(key, "is out of its limits");
      return;
    }
    value = given->second;
  }
  void vector(std::string_view key, Eigen::Vector3d&, const NumberLimits&) override {
    reject(key, "cannot be given here");
  }
  void choice(std::string_view key, std::size_t& value,
              const std::vector<std::string_view>& names) override {
    const auto given = words_.find(std::string(key));
    if (given == words_.end()) return;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == given->second) {
        value = i;
        return;
      }
    }
    reject(key, "is not known");
  }
  void file(std::string_view key, std::filesystem::path&) override {
    reject(key, "cannot be given here");
  }
  void list(std::string_view key, const std::function<void(SettingsReader&)>&) override {
    reject(key, "cannot be given here");
  }
  void reject(std::string_view key, const std::string& sentence) override {
    mistakes_.push_back(std::string(key) + ": " + sentence);
  }

  /// Returns "key: sentence" of each mistake so far.
  const std::vector<std::string>& mistakes() const { return mistakes_; }

 private:
  std::map<std::string, double> numbers_;
  std::map<std::string, std::string> words_;
  std::vector<std::string> mistakes_;
};

}  // namespace thimble::render
