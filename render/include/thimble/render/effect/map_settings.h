#pragma once

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "thimble/driver/export.h"
#include "thimble/render/effect/settings_reader.h"

namespace thimble::render {

/// SettingsReader that takes its values from code, for programs and tests without a scene, and
/// collects mistakes. Vectors, files and lists are not supported. Real-time: never from the servo
/// thread.
class THIMBLE_EXPORT MapSettings final : public SettingsReader {
 public:
  MapSettings() = default;
  /// Constructs a reader from numbers (SI) and words by key.
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
    // Written so that NaN is rejected.
    if (!(given->second >= limits.min && given->second <= limits.max)) {
      reject(key, "is outside its limits");
      return;
    }
    value = given->second;
  }
  void vector(std::string_view key, Eigen::Vector3d&, const NumberLimits&) override {
    reject(key, "cannot be set through MapSettings");
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
    reject(key, "is not an allowed value");
  }
  void text(std::string_view key, std::string& value) override {
    if (const auto given = words_.find(std::string(key)); given != words_.end()) {
      value = given->second;
    }
  }
  void file(std::string_view key, std::filesystem::path&) override {
    reject(key, "cannot be set through MapSettings");
  }
  void list(std::string_view key, const std::function<void(SettingsReader&)>&) override {
    reject(key, "cannot be set through MapSettings");
  }
  void reject(std::string_view key, const std::string& sentence) override {
    mistakes_.push_back(std::string(key) + ": " + sentence);
  }

  /// Returns the mistakes so far as "key: sentence".
  const std::vector<std::string>& mistakes() const { return mistakes_; }

 private:
  std::map<std::string, double> numbers_;
  std::map<std::string, std::string> words_;
  std::vector<std::string> mistakes_;
};

}  // namespace thimble::render
