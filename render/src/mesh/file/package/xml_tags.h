#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace thimble::render {

/// A tag of an XML text.
struct XmlTag {
  std::string_view prefix;  ///< Namespace prefix of its name, before the colon; may be empty.
  std::string_view name;    ///< Name without the prefix.
  bool opens = false;       ///< Whether it begins an element.
  bool closes = false;      ///< Whether it ends an element; `<a/>` does both.
  std::vector<std::pair<std::string_view, std::string_view>> attributes;  ///< From the text.

  /// Returns the value of an attribute, given its name with prefix.
  std::optional<std::string_view> find(std::string_view attribute) const {
    for (const auto& [key, value] : attributes) {
      if (key == attribute) return value;
    }
    return std::nullopt;
  }
};

/// The tags of an XML text, one after the other; text between them, comments and instructions are
/// skipped. Total: any bytes give tags or damage. Nothing outside the text is opened and no entity
/// is expanded. The text must outlive it and its tags.
class XmlTags {
 public:
  explicit XmlTags(std::string_view text) : rest_(text) {}

  /// Reads the next tag. Returns false at the end of the text or at damage. Real-time: never from
  /// the servo thread.
  bool next(XmlTag& tag);
  /// Returns whether reading stopped before the end of the text, because of a tag without an end or
  /// a document type.
  bool damaged() const { return damaged_; }

 private:
  bool skip_past(std::string_view end);
  bool read_attributes(XmlTag& tag);

  std::string_view rest_;
  bool damaged_ = false;
};

/// Returns the value of an attribute with the five entities of XML and numbered characters below
/// 128 decoded. Real-time: never from the servo thread.
std::string plain_text(std::string_view value);

}  // namespace thimble::render
