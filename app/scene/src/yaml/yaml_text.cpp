#include "yaml/yaml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

#include "text/utf8.h"

namespace thimble::scene {
namespace {

/// Returns whether a text is UTF-16 or UTF-32, by its byte order mark or by zero bytes in its first
/// character [YAML 1.2, 5.2].
bool is_wide(std::string_view text) {
  const std::string_view head = text.substr(0, 4);
  return head.starts_with("\xff\xfe") || head.starts_with("\xfe\xff") ||
         head.find('\0') != std::string_view::npos;
}

/// Position in a text that is read character by character.
struct Place {
  int line = 1, column = 1;

  void pass(std::string_view character) {
    ++column;
    if (character == "\n") {
      ++line;
      column = 1;
    }
  }
};

/// A blank character that YAML does not accept as one.
struct OddBlank {
  std::string_view bytes;
  std::string_view name;
};
constexpr std::array kOddBlanks{
    OddBlank{"\xc2\xa0", "a no-break space (U+00A0)"},
    OddBlank{"\xe2\x80\xaf", "a narrow no-break space (U+202F)"},
    OddBlank{"\xe2\x80\x82", "an en space (U+2002)"},
    OddBlank{"\xe2\x80\x83", "an em space (U+2003)"},
    OddBlank{"\xe2\x80\x89", "a thin space (U+2009)"},
    OddBlank{"\xe2\x80\x8b", "a zero-width space (U+200B)"},
    OddBlank{"\xe3\x80\x80", "an ideographic space (U+3000)"},
};

const OddBlank* odd_blank(std::string_view character) {
  for (const OddBlank& odd : kOddBlanks) {
    if (odd.bytes == character) return &odd;
  }
  return nullptr;
}

bool is_blank(std::string_view character) {
  return character == " " || character == "\t" || odd_blank(character) != nullptr;
}

/// Skips the blanks at the beginning of a text, at most a hundred. Returns the rest; "" at the end
/// of the text.
std::string_view skip_blanks(std::string_view text) {
  for (int passed = 0; passed < 100 && !text.empty(); ++passed) {
    const std::string_view character = text.substr(0, std::max<std::size_t>(utf8_length(text), 1));
    if (!is_blank(character)) break;
    text.remove_prefix(character.size());
  }
  return text;
}

bool begins_with_any(std::string_view text, std::string_view letters) {
  return text.empty() || letters.find(text[0]) != std::string_view::npos;
}

/// Tracks quotes, comments and brackets while passing through a YAML text.
class BlankSearch {
 public:
  explicit BlankSearch(std::string_view text) : text_(text) {}

  /// Passes one character. Returns a flaw if it is a misplaced blank.
  std::optional<TextFlaw> next() {
    const std::string_view character =
        text_.substr(0, std::max<std::size_t>(utf8_length(text_), 1));
    const Place here = place_;
    const std::string_view rest = text_.substr(character.size());
    std::optional<TextFlaw> flaw;
    if (character == "\n") {
      indentation_ = after_sign_ = true;
      comment_ = false;
    } else if (quote_ != 0) {
      pass_quoted(character, rest);
    } else if (!comment_) {
      flaw = pass_plain(character, rest);
    }
    pass(escaped_ ? text_.substr(0, 1) : character);
    escaped_ = false;
    if (flaw) {
      flaw->line = here.line;
      flaw->column = here.column;
    }
    return flaw;
  }

  bool at_end() const { return text_.empty(); }

 private:
  void pass(std::string_view character) {
    place_.pass(character);
    before_ = character;
    text_.remove_prefix(character.size());
  }

  void pass_quoted(std::string_view character, std::string_view rest) {
    if (quote_ == '"' && character == "\\" && (rest.starts_with('"') || rest.starts_with('\\'))) {
      pass(character);
      escaped_ = true;
      return;
    }
    if (character[0] == quote_) quote_ = 0;
  }

  std::optional<TextFlaw> pass_plain(std::string_view character, std::string_view rest) {
    if (character == "\t") {
      // Tabs are allowed between brackets and in empty lines.
      if (!indentation_ || depth_ > 0 || begins_with_any(skip_blanks(rest), "\r\n#")) return {};
      return TextFlaw{.what = "a tab cannot indent in YAML; use spaces instead", .indents = true};
    }
    if (const OddBlank* odd = odd_blank(character)) {
      const bool at_end = begins_with_any(skip_blanks(rest), "\r\n#,]}:");
      if (!indentation_ && !after_sign_ && !at_end) return {};
      return TextFlaw{
          .what = fmt::format("{} is not a blank in YAML; use a space instead", odd->name),
          .indents = indentation_};
    }
    if (character == " ") return {};
    if (character == "#" && (is_blank(before_) || before_ == "\n")) {
      comment_ = true;
      return {};
    }
    // Quotes begin a value; within a word they are letters.
    if (after_sign_ && (character == "\"" || character == "'")) quote_ = character[0];
    depth_ += begins_with_any(character, "[{") ? 1 : 0;
    depth_ -= depth_ > 0 && begins_with_any(character, "]}") ? 1 : 0;
    indentation_ = false;
    after_sign_ = begins_with_any(character, ":-,[{?");
    return {};
  }

  std::string_view text_;
  std::string_view before_ = "\n";
  Place place_;
  bool indentation_ = true;  // true: only blanks so far in this line
  bool after_sign_ = true;   // true: only blanks since a sign that YAML requires a blank after
  bool comment_ = false;
  bool escaped_ = false;  // the next character is the second of an escaped pair in quotes
  char quote_ = 0;        // quote character that is open; 0: none
  int depth_ = 0;         // number of open brackets
};

}  // namespace

std::optional<TextFlaw> find_invalid_utf8(std::string_view text) {
  if (is_wide(text)) return std::nullopt;
  Place place;
  while (!text.empty()) {
    const std::size_t length = utf8_length(text);
    if (length == 0) {
      return TextFlaw{
          place.line, place.column,
          fmt::format("the byte 0x{:02X} is not UTF-8; save the file as UTF-8 (it may be "
                      "Latin-1: iconv -f latin1 -t utf8)",
                      static_cast<std::uint8_t>(text[0]))};
    }
    place.pass(text.substr(0, length));
    text.remove_prefix(length);
  }
  return std::nullopt;
}

std::vector<TextFlaw> find_misplaced_blanks(std::string_view text) {
  constexpr std::size_t kFlawsMax = 100;
  std::vector<TextFlaw> flaws;
  if (is_wide(text)) return flaws;
  BlankSearch search(text);
  while (!search.at_end() && flaws.size() < kFlawsMax) {
    if (auto flaw = search.next()) flaws.push_back(*std::move(flaw));
  }
  return flaws;
}

}  // namespace thimble::scene
