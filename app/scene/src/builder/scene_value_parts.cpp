#include "builder/scene_value_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cstddef>
#include <system_error>

namespace thimble::scene {
namespace {

/// Returns whether YAML reads a text without quotes as the same text, and never as a number.
bool is_plain_word(const std::string& text) {
  constexpr std::array<std::string_view, 8> kNotTexts{"true", "false", "null", "Null",
                                                      "NULL", "nan",   "inf",  "infinity"};
  const auto in_word = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("_./-").find(static_cast<char>(c)) !=
                                       std::string_view::npos;  // also names of files
  };
  const bool begins = !text.empty() && (std::isalpha(static_cast<unsigned char>(text.front())) ||
                                        text.front() == '_' || text.front() == '/');
  return begins && std::all_of(text.begin(), text.end(), in_word) &&
         std::find(kNotTexts.begin(), kNotTexts.end(), text) == kNotTexts.end();
}

}  // namespace

std::string SceneValue::Parts::in_yaml(const std::string& text) {
  if (is_plain_word(text)) return text;
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      quoted += '\\';
      quoted += c;
    } else if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      quoted += fmt::format("\\x{:02x}", static_cast<unsigned char>(c));
    } else {
      quoted += c;
    }
  }
  return quoted + '"';
}

const std::string* SceneValue::Parts::text_of(const SceneValue& map, std::string_view key) {
  for (std::size_t i = 0; i < map.keys_.size(); ++i) {
    if (map.keys_[i] == key && map.values_[i].kind_ == Kind::kText) return &map.values_[i].text_;
  }
  return nullptr;
}

std::string SceneValue::Parts::in_line(const SceneValue& value) {
  if (value.kind_ == Kind::kPlain) return value.text_;
  if (value.kind_ == Kind::kText) return in_yaml(value.text_);
  std::string text;
  for (std::size_t i = 0; i < value.values_.size(); ++i) {
    text += i == 0 ? "" : ", ";
    if (is_map(value)) text += in_yaml(value.keys_[i]) + ": ";
    text += in_line(value.values_[i]);
  }
  return is_map(value) ? '{' + text + '}' : '[' + text + ']';
}

void SceneValue::Parts::make_paths_whole(SceneValue& value, const std::filesystem::path& folder) {
  for (SceneValue& inner : value.values_) make_paths_whole(inner, folder);
  if (value.kind_ != Kind::kText || value.text_.empty()) return;
  const std::filesystem::path file(value.text_);
  std::error_code missing;
  if (file.is_absolute() || !std::filesystem::is_regular_file(folder / file, missing)) return;
  value.text_ = (folder / file).lexically_normal().string();
}

}  // namespace thimble::scene
