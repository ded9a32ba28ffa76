#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace thimble::scene {

/// Byte or character that is invalid at its position in a YAML file.
struct TextFlaw {
  int line = 0;          ///< Line, from 1.
  int column = 0;        ///< Column, from 1, in characters.
  std::string what;      ///< Description with the fix; a sentence without a period.
  bool indents = false;  ///< True if it is in indentation, so that YAML sees another structure.
};

/// Returns the first byte of a text that is not UTF-8 [RFC 3629], as in files saved as Latin-1.
/// Empty if there is none, or if the text is UTF-16 or UTF-32, which the parser supports too.
/// Real-time: never from the servo thread.
std::optional<TextFlaw> find_invalid_utf8(std::string_view text);

/// Returns whitespace that YAML does not accept as such where it expects some. These are tabs in
/// indentation, and no-break and other special spaces in indentation, next to `:`, `-`, `,`,
/// brackets and `#`, and at the ends of lines, outside of quotes and comments. At most the first
/// hundred are returned. They are not mistakes by themselves: texts with several lines may contain
/// them. `text` is UTF-8. Real-time: never from the servo thread.
std::vector<TextFlaw> find_misplaced_blanks(std::string_view text);

}  // namespace thimble::scene
