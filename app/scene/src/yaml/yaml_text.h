#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace thimble::scene {

/// A byte or character of a text that a YAML file cannot have at its place.
struct TextFlaw {
  int line = 0;          ///< From 1.
  int column = 0;        ///< From 1, in characters.
  std::string what;      ///< A sentence without a dot, with the remedy.
  bool indents = false;  ///< It is in indentation, so that YAML sees another structure.
};

/// Returns the first byte of a text that is not UTF-8 [RFC 3629], as in files saved as Latin-1;
/// nothing if there is none, or if the text is UTF-16 or UTF-32, which the parser reads too.
/// Real-time: never from the servo thread.
std::optional<TextFlaw> find_invalid_utf8(std::string_view text);

/// Returns blanks that YAML does not take for blanks, where it expects some: tabs in indentation,
/// and no-break and other special spaces in indentation, beside `:`, `-`, `,`, brackets and `#`,
/// and at the ends of lines, outside of quotes and comments. The first hundred are enough. They are
/// no mistake by themselves: texts in several lines may hold them. `text` is UTF-8. Real-time:
/// never from the servo thread.
std::vector<TextFlaw> find_misplaced_blanks(std::string_view text);

}  // namespace thimble::scene
