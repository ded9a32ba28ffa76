#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thimble::render {

/// A tag of an XML text.
struct XmlTag {
  std::string_view prefix;  ///< Of its name, before the colon; may be empty.
  std::string_view name;    ///< Without the prefix.
  bool opens = false;       ///< Whether it begins an element.
  bool closes = false;      ///< Whether it ends one; `<a/>` does both.
  std::vector<std::pair<std::string_view, std::string_view>> attributes;  ///< As in the text.

  /// Returns the value of an attribute, named with its prefix.
  std::optional<std::string_view> find(std::string_view attribute) const {
    for (const auto& [key, value] : attributes) {
      if (key == attribute) return value;
    }
    return std::nullopt;
  }
};

/// The tags of an XML text, one after the other; text between them, comments and instructions are
/// left out. Total: any bytes give tags or damage; nothing outside of the text is opened and no
/// entity is expanded. The text must outlive it and its tags.
class XmlTags {
 public:
  explicit XmlTags(std::string_view text) : rest_(text) {}

  /// Reads the next tag; false at the end of the text or at damage. Real-time: never from the servo
  /// thread.
  bool next(XmlTag& tag);
  /// Returns whether reading stopped before the end of the text: a tag that does not end, or a
  /// document type.
  bool damaged() const { return damaged_; }

 private:
  bool skip_past(std::string_view end);
  bool read_attributes(XmlTag& tag);

  std::string_view rest_;
  bool damaged_ = false;
};

/// Returns the value of an attribute with the five entities of XML and numbered characters below
/// 128 in plain letters. Real-time: never from the servo thread.
std::string plain_text(std::string_view value);

}  // namespace thimble::render
