#include "yaml/yaml_reader.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <optional>
#include <unordered_map>

#include "text/nearest_word.h"
#include "thimble/driver/orientation.h"
#include "yaml/renamed_keys.h"
#include "yaml/yaml_words.h"

namespace thimble::scene {
namespace {

KeyValues whole_values(ValueType type, std::int64_t min, std::int64_t max) {
  return {type, static_cast<double>(min), static_cast<double>(max)};
}

KeyValues choice_values(ValueType type, const std::vector<std::string_view>& choices) {
  return {.type = type, .choices = {choices.begin(), choices.end()}};
}

}  // namespace

YamlMap::YamlMap(const YamlNode& node, std::string_view name, int line,
                 std::shared_ptr<YamlMistakes> mistakes)
    : mistakes_(std::move(mistakes)), line_(line_of(node, line)) {
  if (!node.is_map()) {
    quiet_ = true;
    const std::string prefix = name.empty() ? "" : std::string(name) + ": ";
    mistakes_->add(line_, prefix + "expected a map of keys and values, found " + found(node));
    return;
  }
  constexpr std::size_t kFew = 16;  // [chosen: a search among them is faster than a hash]
  std::unordered_map<std::string_view, int> lines;  // by key, if there are many
  entries_.reserve(node.size());
  node.each_pair([&](const YamlNode& key_node, const YamlNode& value) {
    const int key_line = line_of(key_node, line_);
    if (!key_node.is_scalar()) {
      mistakes_->add(key_line, "expected a word as key, found " + found(key_node));
      return;
    }
    const std::string_view key = key_node.text();  // `node` owns the text
    int first = 0;
    if (node.size() <= kFew) {
      first = this->key_line(key);
    } else if (const auto [known, fresh] = lines.try_emplace(key, key_line); !fresh) {
      first = known->second;
    }
    if (first != 0) {
      mistakes_->add(key_line, std::string(key) + ": occurs twice, first in line " +
                                   std::to_string(first) + "; keep one of them");
      return;
    }
    entries_.push_back({std::string(key), key_line, value});
  });
}

const YamlMap::Entry* YamlMap::find(std::string_view key, bool required) {
  if (std::find(requested_.begin(), requested_.end(), key) == requested_.end())
    requested_.emplace_back(key);
  for (const Entry& entry : entries_) {
    if (entry.key == key) return &entry;
  }
  for (const RenamedKey& renamed : kRenamedKeys) {
    if (renamed.place != place_ || renamed.is != key) continue;
    for (Entry& entry : entries_) {
      if (entry.key != renamed.was) continue;
      mistakes_->warn(entry.line, entry.key + ": is now called " + std::string(key) +
                                      "; the old name still works, but use the new one");
      entry.key = key;
      return &entry;
    }
  }
  if (required && !quiet_) mistakes_->add(line_, std::string(key) + ": is missing");
  return nullptr;
}

void YamlMap::note(std::string_view key, KeyValues values, std::string what, bool required,
                   std::string fallback) {
  if (mistakes_->keys() == nullptr) return;
  const std::size_t three = what.find("three");
  if (motors_ != 0 && three != std::string::npos) {
    values.per_motor = true;
    what.replace(three, 5, "one to three");
  }
  mistakes_->keys()->note({.place = place_,
                           .key = std::string(key),
                           .what = std::move(what),
                           .need = required ? KeyNeed::kRequired : KeyNeed::kOptional,
                           .fallback = std::move(fallback),
                           .values = std::move(values)});
}

int YamlMap::key_line(std::string_view key) const {
  for (const Entry& entry : entries_) {
    if (entry.key == key) return entry.line;
  }
  return 0;
}

void YamlMap::expected(const Entry& entry, const std::string& what) {
  mistakes_->add(line_of(entry.value, entry.line),
                 entry.key + ": expected " + what + ", found " + found(entry.value));
}

bool YamlMap::read_number(const Entry& entry, const YamlNode& node, std::string_view unit,
                          double min, double max, double& number) {
  const std::optional<double> value = to_number(node);
  // Written so that NaN is rejected.
  if (value && *value >= min && *value <= max) {
    number = *value;
    return true;
  }
  mistakes_->add(
      line_of(node, entry.line),
      entry.key + ": expected " + number_in_words(unit, min, max) + ", found " + found_value(node));
  return false;
}

bool YamlMap::read_whole(const Entry& entry, const YamlNode& node, const std::string& what,
                         std::int64_t min, std::int64_t max, std::int64_t& number) {
  const std::optional<std::int64_t> value = to_whole(node);
  if (value && *value >= min && *value <= max) {
    number = *value;
    return true;
  }
  mistakes_->add(line_of(node, entry.line),
                 entry.key + ": expected " + what + ", found " + found_value(node));
  return false;
}

bool YamlMap::has(std::string_view key) {
  if (mistakes_->keys() != nullptr && mistakes_->keys()->checked(place_, key)) return true;
  return find(key, false) != nullptr;
}

double YamlMap::require_number(std::string_view key, std::string_view unit, double min,
                               double max) {
  if (logs_keys()) {
    note(key, {ValueType::kNumber, min, max}, number_in_words(unit, min, max), true);
  }
  double number = min;
  if (const Entry* entry = find(key, true)) {
    read_number(*entry, entry->value, unit, min, max, number);
  }
  return number;
}

double YamlMap::optional_number(std::string_view key, double fallback, std::string_view unit,
                                double min, double max) {
  if (logs_keys()) {
    note(key, {ValueType::kNumber, min, max}, number_in_words(unit, min, max), false,
         in_words(fallback));
  }
  return has(key) ? require_number(key, unit, min, max) : fallback;
}

std::int64_t YamlMap::require_whole(std::string_view key, std::string_view unit, std::int64_t min,
                                    std::int64_t max) {
  const std::string what = whole_in_words(unit, min, max);
  note(key, whole_values(ValueType::kWhole, min, max), what, true);
  std::int64_t number = min;
  if (const Entry* entry = find(key, true)) {
    read_whole(*entry, entry->value, what, min, max, number);
  }
  return number;
}

std::int64_t YamlMap::optional_whole(std::string_view key, std::int64_t fallback,
                                     std::string_view unit, std::int64_t min, std::int64_t max) {
  note(key, whole_values(ValueType::kWhole, min, max), whole_in_words(unit, min, max), false,
       std::to_string(fallback));
  return has(key) ? require_whole(key, unit, min, max) : fallback;
}

const YamlMap::Entry* YamlMap::find_three(std::string_view key, std::string_view what) {
  const Entry* entry = find(key, true);
  if (entry == nullptr) return nullptr;
  if (entry->value.is_list() && entry->value.size() == list_length()) return entry;
  constexpr std::array<std::string_view, 3> kNumbers{"one", "two", "three"};
  expected(*entry, "a list of " + std::string(kNumbers[list_length() - 1]) + ' ' +
                       std::string(what) + (list_length() == 3 ? "" : ", one per motor"));
  return nullptr;
}

std::array<std::int64_t, 3> YamlMap::require_three_whole(std::string_view key,
                                                         std::string_view unit, std::int64_t min,
                                                         std::int64_t max) {
  const std::string what = whole_in_words(unit, min, max);
  note(key, whole_values(ValueType::kThreeWhole, min, max),
       "three whole numbers, each" + what.substr(14), true);
  std::array<std::int64_t, 3> numbers{};
  const Entry* entry = find_three(key, "whole numbers");
  for (std::size_t i = 0; entry != nullptr && i < list_length(); ++i) {
    if (!read_whole(*entry, entry->value[i], what, min, max, numbers[i])) return {};
  }
  return numbers;
}

std::array<std::int64_t, 3> YamlMap::optional_three_whole(
    std::string_view key, const std::array<std::int64_t, 3>& fallback, std::string_view unit,
    std::int64_t min, std::int64_t max) {
  note(key, whole_values(ValueType::kThreeWhole, min, max),
       "three whole numbers, each" + whole_in_words(unit, min, max).substr(14), false,
       '[' + std::to_string(fallback[0]) + ", " + std::to_string(fallback[1]) + ", " +
           std::to_string(fallback[2]) + ']');
  return has(key) ? require_three_whole(key, unit, min, max) : fallback;
}

std::array<std::int64_t, 3> YamlMap::require_signs(std::string_view key) {
  note(key, {ValueType::kSigns}, "three signs, each 1 or -1", true);
  const Entry* entry = find_three(key, "signs, each 1 or -1");
  std::array<std::int64_t, 3> signs{1, 1, 1};
  for (std::size_t i = 0; entry != nullptr && i < list_length(); ++i) {
    const auto sign = to_whole(entry->value[i]);
    if (sign && (*sign == 1 || *sign == -1)) {
      signs[i] = *sign;
      continue;
    }
    mistakes_->add(
        line_of(entry->value[i], entry->line),
        entry->key + ": expected each to be 1 or -1, found " + found_value(entry->value[i]));
    return {1, 1, 1};
  }
  return signs;
}

Eigen::Vector3d YamlMap::require_vector3(std::string_view key, std::string_view unit, double min,
                                         double max) {
  if (logs_keys()) {
    note(key, {ValueType::kThreeNumbers, min, max}, three_in_words(unit, min, max), true);
  }
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  const Entry* entry =
      find_three(key, "numbers" + (unit.empty() ? "" : " in " + std::string(unit)));
  if (entry == nullptr) return vector;
  for (std::size_t i = 0; i < list_length(); ++i) {
    double number = 0;
    if (!read_number(*entry, entry->value[i], unit, min, max, number)) {
      return Eigen::Vector3d::Zero();
    }
    vector[static_cast<Eigen::Index>(i)] = number;
  }
  return vector;
}

Eigen::Vector3d YamlMap::optional_vector3(std::string_view key, const Eigen::Vector3d& fallback,
                                          std::string_view unit, double min, double max) {
  if (logs_keys()) {
    note(key, {ValueType::kThreeNumbers, min, max}, three_in_words(unit, min, max), false,
         '[' + in_words(fallback.x()) + ", " + in_words(fallback.y()) + ", " +
             in_words(fallback.z()) + ']');
  }
  return has(key) ? require_vector3(key, unit, min, max) : fallback;
}

Eigen::Matrix3d YamlMap::optional_rotation(std::string_view key) {
  const std::string what = "a list of rotations such as [[x, 90], [z, -45]], in degrees";
  note(key, {ValueType::kRotation}, what, false, "no rotation");
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  const Entry* entry = find(key, false);
  if (entry == nullptr) return R;
  if (!entry->value.is_list()) {
    expected(*entry, what);
    return R;
  }
  bool rotated = true;
  entry->value.each_entry([&](const YamlNode& turn) {
    if (!rotated) return;
    const bool is_pair = turn.is_list() && turn.size() == 2 && turn[0].is_scalar();
    const std::string_view axis = is_pair ? turn[0].text() : std::string_view();
    if (axis != "x" && axis != "y" && axis != "z") {
      mistakes_->add(line_of(turn, entry->line), entry->key + ": expected " + what + ", found " +
                                                     (is_pair ? in_quotes(axis) : found(turn)));
      rotated = false;
      return;
    }
    double degrees = 0;
    if (!read_number(*entry, turn[1], "degrees", -360, 360, degrees)) {
      rotated = false;
      return;
    }
    R = driver::rotation_about(static_cast<driver::FrameAxis>(axis[0] - 'x'),
                               degrees * std::numbers::pi / 180) *
        R;
  });
  return rotated ? R : Eigen::Matrix3d::Identity();
}

std::string YamlMap::require_string(std::string_view key) {
  note(key, {ValueType::kText}, "a text", true);
  const Entry* entry = find(key, true);
  if (entry == nullptr) return "";
  if (!entry->value.is_scalar() || entry->value.text().empty()) {
    expected(*entry, "a text");
    return "";
  }
  return std::string(entry->value.text());
}

std::string YamlMap::optional_string(std::string_view key, std::string_view fallback) {
  note(key, {ValueType::kText}, "a text", false, std::string(fallback));
  return has(key) ? require_string(key) : std::string(fallback);
}

std::size_t YamlMap::require_choice(std::string_view key,
                                    const std::vector<std::string_view>& choices) {
  note(key, choice_values(ValueType::kChoice, choices), any_of(choices), true);
  const Entry* entry = find(key, true);
  if (entry == nullptr) return 0;
  if (const auto chosen = choice_of(entry->value, choices)) return *chosen;
  expected(*entry, any_of(choices));
  return 0;
}

std::vector<std::size_t> YamlMap::optional_choices(std::string_view key,
                                                   const std::vector<std::size_t>& fallback,
                                                   const std::vector<std::string_view>& choices) {
  const std::string what = any_of(choices) + ", or a list of them";
  note(key, choice_values(ValueType::kChoices, choices), what, false);
  const Entry* entry = find(key, false);
  if (entry == nullptr) return fallback;
  std::vector<std::size_t> chosen;
  if (entry->value.is_scalar()) {
    if (const auto one = choice_of(entry->value, choices)) chosen.push_back(*one);
  } else if (entry->value.is_list()) {
    bool known = true;
    entry->value.each_entry([&](const YamlNode& node) {
      const auto one = choice_of(node, choices);
      known = known && one;
      if (known) chosen.push_back(*one);
    });
    if (!known) chosen.clear();
  }
  if (chosen.empty()) expected(*entry, what);
  return chosen;
}

std::size_t YamlMap::optional_choice(std::string_view key, std::size_t fallback,
                                     const std::vector<std::string_view>& choices) {
  note(key, choice_values(ValueType::kChoice, choices), any_of(choices), false,
       fallback < choices.size() ? std::string(choices[fallback]) : "");
  return has(key) ? require_choice(key, choices) : fallback;
}

bool YamlMap::optional_bool(std::string_view key, bool fallback) {
  note(key, {ValueType::kBool}, "true or false", false, fallback ? "true" : "false");
  const Entry* entry = find(key, false);
  if (entry == nullptr) return fallback;
  if (is_plain_scalar(entry->value)) {
    if (entry->value.text() == "true") return true;
    if (entry->value.text() == "false") return false;
  }
  mistakes_->add(line_of(entry->value, entry->line),
                 entry->key + ": expected true or false, found " + found_value(entry->value));
  return fallback;
}

YamlMap YamlMap::require_map(std::string_view key) {
  note(key, {ValueType::kMap}, "a map", true);
  const std::string place = place_.empty() ? std::string(key) : place_ + '.' + std::string(key);
  if (const Entry* entry = find(key, true)) {
    YamlMap map(entry->value, key, entry->line, mistakes_);
    map.place_ = place;
    return map;
  }
  YamlMap absent(YamlNode::empty_map(), key, line_, mistakes_);
  absent.quiet_ = true;
  absent.place_ = place;
  return absent;
}

std::vector<YamlMap> YamlMap::require_maps(std::string_view key) {
  std::vector<YamlMap> maps;
  maps.reserve(list_size(key));
  visit_maps(key, [&maps](YamlMap& map) { maps.push_back(std::move(map)); });
  return maps;
}

void YamlMap::visit_maps(std::string_view key, const std::function<void(YamlMap&)>& visit) {
  note(key, {ValueType::kMaps}, "a list of maps, at least one", true);
  const std::string place =
      (place_.empty() ? std::string(key) : place_ + '.' + std::string(key)) + "[]";
  const Entry* entry = find(key, true);
  if (entry == nullptr) {
    if (mistakes_->keys() == nullptr) return;
    // An entry without values, so that its keys are requested and logged.
    YamlMap map(YamlNode::empty_map(), key, line_, mistakes_);
    map.quiet_ = true;
    map.place_ = place;
    visit(map);
    return;
  }
  if (!entry->value.is_list() || entry->value.size() == 0) {
    expected(*entry, "a list with at least one entry");
    return;
  }
  entry->value.each_entry([&](const YamlNode& node) {
    YamlMap map(node, key, entry->line, mistakes_);
    map.place_ = place;
    visit(map);
  });
}

std::size_t YamlMap::list_size(std::string_view key) const {
  for (const Entry& entry : entries_) {
    if (entry.key == key) return entry.value.is_list() ? entry.value.size() : 0;
  }
  return 0;
}

int YamlMap::line_for(std::string_view key) {
  const Entry* entry = key.empty() ? nullptr : find(key, false);
  return entry != nullptr ? line_of(entry->value, entry->line) : line_;
}

void YamlMap::reject(std::string_view key, const std::string& sentence) {
  mistakes_->add_check(line_for(key), (key.empty() ? "" : std::string(key) + ": ") + sentence);
}

void YamlMap::refuse(std::string_view key, const std::string& sentence) {
  mistakes_->add(line_for(key), (key.empty() ? "" : std::string(key) + ": ") + sentence);
}

void YamlMap::finish() {
  if (mistakes_->keys() != nullptr) mistakes_->keys()->finished(place_, requested_);
  for (const Entry& entry : entries_) {
    if (std::find(requested_.begin(), requested_.end(), entry.key) != requested_.end()) continue;
    // The last explanation of a key counts.
    const auto unused = std::find_if(unused_.rbegin(), unused_.rend(),
                                     [&](const auto& one) { return one.first == entry.key; });
    if (unused != unused_.rend()) {
      mistakes_->add(entry.line, entry.key + ": " + unused->second);
      continue;
    }
    std::string sentence = entry.key + ": unknown key";
    if (mistakes_->full()) {  // only counted from here on
      mistakes_->add(entry.line, sentence);
      continue;
    }
    for (const RenamedKey& renamed : kRenamedKeys) {
      if (renamed.place != place_ || renamed.was != entry.key || key_line(renamed.is) == 0)
        continue;
      sentence = entry.key + ": is the old name of " + std::string(renamed.is) +
                 ", which is here too; keep the new one";
    }
    const auto near = nearest_word(entry.key, requested_);
    if (near) sentence += " (did you mean " + in_quotes(*near) + "?)";
    mistakes_->add(entry.line, sentence);
  }
}

}  // namespace thimble::scene
