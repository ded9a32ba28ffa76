#include "mesh/file/package/xml_tags.h"

#include <algorithm>
#include <array>

#include "mesh/file/text_words.h"

namespace thimble::render {
namespace {

constexpr std::string_view kSpace = " \t\r\n";

void skip_space(std::string_view& text) {
  text.remove_prefix(std::min(text.find_first_not_of(kSpace), text.size()));
}

}  // namespace

bool XmlTags::skip_past(std::string_view end) {
  const std::size_t at = rest_.find(end);
  if (at == std::string_view::npos) return false;
  rest_.remove_prefix(at + end.size());
  return true;
}

bool XmlTags::next(XmlTag& tag) {
  while (!damaged_) {
    const std::size_t begin = rest_.find('<');
    if (begin == std::string_view::npos) return false;
    rest_.remove_prefix(begin);
    if (rest_.starts_with("<!--")) {
      damaged_ = !skip_past("-->");
    } else if (rest_.starts_with("<![CDATA[")) {
      damaged_ = !skip_past("]]>");
    } else if (rest_.starts_with("<?")) {
      damaged_ = !skip_past("?>");
    } else if (rest_.starts_with("<!")) {
      damaged_ = true;
    } else {
      damaged_ = !read_attributes(tag);
      return !damaged_;
    }
  }
  return false;
}

bool XmlTags::read_attributes(XmlTag& tag) {
  tag = {};
  rest_.remove_prefix(1);
  tag.closes = rest_.starts_with('/');
  tag.opens = !tag.closes;
  if (tag.closes) rest_.remove_prefix(1);
  const std::size_t name = rest_.find_first_of(" \t\r\n/>");
  if (name == std::string_view::npos || name == 0) return false;
  tag.name = rest_.substr(0, name);
  if (const std::size_t colon = tag.name.find(':'); colon != std::string_view::npos) {
    tag.prefix = tag.name.substr(0, colon);
    tag.name.remove_prefix(colon + 1);
  }
  rest_.remove_prefix(name);
  for (;;) {
    skip_space(rest_);
    if (rest_.starts_with('>')) break;
    if (rest_.starts_with("/>") && tag.opens) {
      tag.closes = true;
      rest_.remove_prefix(1);
      break;
    }
    const std::size_t key_end = rest_.find_first_of(" \t\r\n=/><");
    if (key_end == std::string_view::npos || key_end == 0) return false;
    const std::string_view key = rest_.substr(0, key_end);
    rest_.remove_prefix(key_end);
    skip_space(rest_);
    if (!rest_.starts_with('=')) return false;
    rest_.remove_prefix(1);
    skip_space(rest_);
    if (!rest_.starts_with('"') && !rest_.starts_with('\'')) return false;
    const std::size_t value_end = rest_.find(rest_[0], 1);
    if (value_end == std::string_view::npos) return false;
    tag.attributes.emplace_back(key, rest_.substr(1, value_end - 1));
    rest_.remove_prefix(value_end + 1);
  }
  rest_.remove_prefix(1);
  return true;
}

std::string plain_text(std::string_view value) {
  constexpr std::array<std::pair<std::string_view, char>, 5> kNamed{
      {{"amp", '&'}, {"lt", '<'}, {"gt", '>'}, {"quot", '"'}, {"apos", '\''}}};
  std::string plain;
  while (!value.empty()) {
    const std::size_t end = value[0] == '&' ? value.find(';') : std::string_view::npos;
    if (end == std::string_view::npos) {
      plain += value[0];
      value.remove_prefix(1);
      continue;
    }
    const std::string_view entity = value.substr(1, end - 1);
    for (const auto& [name, letter] : kNamed) {
      if (entity == name) plain += letter;
    }
    if (entity.starts_with('#')) {
      const auto code = whole_number(entity.substr(1));
      if (code && *code > 0 && *code < 128) plain += static_cast<char>(*code);
    }
    value.remove_prefix(end + 1);
  }
  return plain;
}

}  // namespace thimble::render
