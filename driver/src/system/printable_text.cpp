#include "system/printable_text.h"

#include <array>
#include <cstddef>

namespace thimble::driver {
namespace {

/// Characters that reorder text or break a line (Unicode 15, annexes 9 and 14).
struct Range {
  char32_t first, last;
};
constexpr std::array kMoving{Range{0x61C, 0x61C},   Range{0x200E, 0x200F}, Range{0x2028, 0x202E},
                             Range{0x2066, 0x206F}, Range{0xFFF9, 0xFFFB}, Range{0xE0000, 0xE007F}};

/// One character at the beginning of a text: its length in bytes, and its number.
struct Character {
  std::size_t length;
  char32_t code;
};

/// Returns the first character of a text; its length is 0 if it is not UTF-8.
Character first_of(std::string_view text) {
  const auto byte = [&text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  if (byte(0) < 0x80) return {1, byte(0)};
  const std::size_t length = byte(0) >= 0xF0 ? 4 : byte(0) >= 0xE0 ? 3 : 2;
  if (byte(0) < 0xC2 || byte(0) > 0xF4 || text.size() < length) return {0, 0};
  char32_t code = byte(0) & (0x7FU >> length);
  for (std::size_t i = 1; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80) return {0, 0};
    code = code << 6U | (byte(i) & 0x3FU);
  }
  // Overlong forms, halves of surrogate pairs, and numbers beyond Unicode.
  const bool long_form = (length == 3 && code < 0x800) || (length == 4 && code < 0x10000);
  if (long_form || (code >= 0xD800 && code < 0xE000) || code > 0x10FFFF) return {0, 0};
  return {length, code};
}

bool moves(char32_t code) {
  if (code < 0x20 || (code >= 0x7F && code < 0xA0)) return true;
  for (const Range& range : kMoving) {
    if (code >= range.first && code <= range.last) return true;
  }
  return false;
}

std::string replace_unprintable(std::string_view text, bool lines) {
  std::string shown;
  shown.reserve(text.size());
  while (!text.empty()) {
    const Character character = first_of(text);
    const bool kept = lines && (character.code == U'\n' || character.code == U'\t');
    if (character.length == 0 || (moves(character.code) && !kept)) {
      shown += '?';
    } else {
      shown += text.substr(0, character.length);
    }
    text.remove_prefix(character.length == 0 ? 1 : character.length);
  }
  return shown;
}

}  // namespace

std::string printable(std::string_view text) {
  return replace_unprintable(text, true);
}

std::string printable_name(std::string_view text) {
  return replace_unprintable(text, false);
}

}  // namespace thimble::driver
