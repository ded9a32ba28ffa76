#include "yaml/yaml_words.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <sstream>
#include <system_error>

namespace thimble::scene {
namespace {

constexpr std::size_t kFoundLengthMax =
    40;  // [chosen: fits into a line with the rest of the message]

}  // namespace

int line_of(const YamlNode& node, int fallback) {
  // The parser marks a missing value where it detected it, which may be the next line.
  return node.is_null() || node.line() == 0 ? fallback : node.line();
}

std::string in_quotes(std::string_view text) {
  std::string result = "\"";
  std::size_t length = std::min(text.size(), kFoundLengthMax);
  // Never splits a character [RFC 3629].
  while (length < text.size() && length > 0 && (text[length] & 0xc0) == 0x80) --length;
  for (const char c : text.substr(0, length)) {
    result += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  if (text.size() > length) result += "...";
  result += '"';
  return result;
}

std::string found(const YamlNode& node) {
  switch (node.type()) {
    case YamlNode::Type::kNull:
      return "nothing";
    case YamlNode::Type::kScalar:
      return in_quotes(node.text());
    case YamlNode::Type::kList:
      return "a list of " + std::to_string(node.size());
    case YamlNode::Type::kMap:
      return "a map";
  }
  return "nothing";
}

std::string found_value(const YamlNode& node) {
  const bool is_value = node.is_scalar() && node.is_quoted() &&
                        (to_number(node.text()) || node.text() == "true" || node.text() == "false");
  return found(node) + (is_value ? ", a text because of its quotes; remove the quotes" : "");
}

std::string in_words(double number) {
  std::ostringstream text;
  text << number;
  return text.str();
}

std::string number_in_words(std::string_view unit, double min, double max) {
  std::string text = "a number from " + in_words(min) + " to " + in_words(max);
  if (!unit.empty()) text.append(" ").append(unit);
  return text;
}

// A scalar in quotes is always a text.
bool is_plain_scalar(const YamlNode& node) {
  return node.is_scalar() && !node.is_quoted();
}

std::optional<double> to_number(const YamlNode& node) {
  return is_plain_scalar(node) ? to_number(node.text()) : std::nullopt;
}

std::optional<double> to_number(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double number = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (status != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number;
}

std::optional<std::int64_t> to_whole(const YamlNode& node) {
  return is_plain_scalar(node) ? to_whole(node.text()) : std::nullopt;
}

std::optional<std::int64_t> to_whole(std::string_view text) {
  constexpr std::int64_t kExactIntegerMax = std::int64_t{1}
                                            << 53;  // up to here every integer is a double
  if (text.starts_with('+')) text.remove_prefix(1);
  std::int64_t number = 0;
  const char* const last = text.data() + text.size();
  if (const auto [end, status] = std::from_chars(text.data(), last, number);
      end != last || status != std::errc()) {
    // 1e3 and 7.0 are integers. The limit is exclusive, because a larger value may have been
    // rounded to it.
    const std::optional<double> decimal = to_number(text);
    if (!decimal || !(std::abs(*decimal) < static_cast<double>(kExactIntegerMax)))
      return std::nullopt;
    if (*decimal != std::floor(*decimal)) return std::nullopt;
    number = static_cast<std::int64_t>(*decimal);
  }
  if (number > kExactIntegerMax || number < -kExactIntegerMax) return std::nullopt;
  return number;
}

std::optional<std::size_t> choice_of(const YamlNode& node,
                                     const std::vector<std::string_view>& choices) {
  if (!node.is_scalar()) return std::nullopt;
  const auto found = std::find(choices.begin(), choices.end(), node.text());
  if (found == choices.end()) return std::nullopt;
  return static_cast<std::size_t>(found - choices.begin());
}

std::string any_of(const std::vector<std::string_view>& choices) {
  std::string what;
  for (std::size_t i = 0; i < choices.size(); ++i) {
    what.append(i == 0 ? "" : i + 1 == choices.size() ? " or " : ", ").append(choices[i]);
  }
  return what;
}

std::string whole_in_words(std::string_view unit, std::int64_t min, std::int64_t max) {
  std::string text = "a whole number from " + std::to_string(min) + " to " + std::to_string(max);
  if (!unit.empty()) text.append(" ").append(unit);
  return text;
}

std::string three_in_words(std::string_view unit, double min, double max) {
  return "three numbers, each" + number_in_words(unit, min, max).substr(8);
}

}  // namespace thimble::scene
