#pragma once

#include <cmath>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "thimble/render/effect/settings_reader.h"

namespace thimble::support {

/// Returns settings of an effect from a map in the test, and collects its errors.
class VariantSettings final : public render::SettingsReader {
 public:
  using Value = std::variant<double, Eigen::Vector3d, std::string>;
  using Values = std::map<std::string, Value, std::less<>>;
  using Lists = std::map<std::string, std::vector<Values>, std::less<>>;

  explicit VariantSettings(Values values, Lists lists = {})
      : values_(std::move(values)), lists_(std::move(lists)) {}

  bool has(std::string_view key) override { return values_.contains(key) || lists_.contains(key); }
  void number(std::string_view key, double& value, const render::NumberLimits& limits) override {
    if (const auto* found = find<double>(key, limits.required)) {
      check(key, *found, limits) ? value = *found : value = limits.min;
    }
  }
  void vector(std::string_view key, Eigen::Vector3d& value,
              const render::NumberLimits& limits) override {
    const auto* found = find<Eigen::Vector3d>(key, limits.required);
    if (found == nullptr) return;
    for (const double one : *found) {
      if (!check(key, one, limits)) return;
    }
    value = *found;
  }
  void choice(std::string_view key, std::size_t& value,
              const std::vector<std::string_view>& names) override {
    const auto* found = find<std::string>(key, false);
    if (found == nullptr) return;
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (names[i] == *found) value = i;
    }
  }
  void file(std::string_view key, std::filesystem::path& value) override {
    if (const auto* found = find<std::string>(key, true)) value = *found;
  }
  void list(std::string_view key,
            const std::function<void(render::SettingsReader&)>& read) override {
    if (!lists_.contains(key)) return reject(key, "expected a list");
    for (const Values& values : lists_.find(key)->second) {
      VariantSettings entry(values);
      read(entry);
      mistakes += entry.mistakes;
    }
  }
  void reject(std::string_view key, const std::string& sentence) override {
    mistakes += std::string(key) + " " + sentence + "\n";
  }

  std::string mistakes;  ///< One per line.

 private:
  template <class T>
  const T* find(std::string_view key, bool required) {
    const auto found = values_.find(key);
    if (found != values_.end()) return std::get_if<T>(&found->second);
    if (required) reject(key, "is missing");
    return nullptr;
  }
  bool check(std::string_view key, double value, const render::NumberLimits& limits) {
    const bool good = std::isfinite(value) && value >= limits.min && value <= limits.max;
    if (!good) reject(key, "expected a number within its limits");
    return good;
  }

  Values values_;
  Lists lists_;
};

}  // namespace thimble::support
