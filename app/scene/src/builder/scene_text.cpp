#include "builder/scene_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "builder/scene_value_parts.h"
#include "yaml/yaml_words.h"

namespace thimble::scene {
namespace {

constexpr std::string_view kWholeScene = "scene";

}  // namespace

std::string SceneText::entry_place(std::string_view key, std::size_t number,
                                   const SceneValue& entry) {
  constexpr std::array<std::pair<std::string_view, std::string_view>, 5> kEntries{
      {{"objects", "object"},
       {"arms", "arm"},
       {"joints", "joint"},
       {"effects", "effect"},
       {"path", "point"}}};
  for (const auto& [list, one] : kEntries) {
    if (list == key) key = one;
  }
  std::string text = fmt::format("{} {}", key, number);
  const std::string* name = SceneValue::Parts::text_of(entry, "name");
  if (name == nullptr) return text;
  const std::string quoted = in_quotes(*name);  // shortened, without control characters
  const std::size_t end = quoted.rfind('"');
  return text + " '" + quoted.substr(1, end - 1) + quoted.substr(end + 1) + "'";
}

SceneText::SceneText(const SceneMap& scene) : places_{std::string(kWholeScene)} {
  write_map(SceneValue(scene), 0, "", "");
}

void SceneText::add_line(const std::string& line, const std::string& place) {
  text_ += line + '\n';
  places_.push_back(place.empty() ? std::string(kWholeScene) : place);
}

void SceneText::write_map(const SceneValue& map, std::size_t indent, std::string_view begin,
                          const std::string& place) {
  using Parts = SceneValue::Parts;
  if (Parts::keys(map).empty()) add_line(std::string(begin) + "{}", place);
  for (std::size_t i = 0; i < Parts::keys(map).size(); ++i) {
    text_ += i == 0 ? std::string(begin) : std::string(indent, ' ');
    write_value(Parts::keys(map)[i], Parts::values(map)[i], indent, place);
  }
}

void SceneText::write_value(const std::string& key, const SceneValue& value, std::size_t indent,
                            const std::string& place) {
  using Parts = SceneValue::Parts;
  const std::string before = place.empty() ? "" : place + ": ";
  const std::string inner(indent + 2, ' ');
  if (Parts::is_map(value)) {
    add_line(Parts::in_yaml(key) + ':', place);
    write_map(value, indent + 2, inner, before + key);
    return;
  }
  const std::vector<SceneValue>& entries = Parts::values(value);
  if (!Parts::is_list(value) || std::none_of(entries.begin(), entries.end(), Parts::is_map)) {
    add_line(Parts::in_yaml(key) + ": " + Parts::in_line(value), place);
    return;
  }
  add_line(Parts::in_yaml(key) + ':', place);
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const std::string name = before + entry_place(key, i + 1, entries[i]);
    if (Parts::is_map(entries[i])) {
      write_map(entries[i], indent + 4, inner + "- ", name);
    } else {
      add_line(inner + "- " + Parts::in_line(entries[i]), name);
    }
  }
}

}  // namespace thimble::scene
