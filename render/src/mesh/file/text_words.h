#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "thimble/driver/result.h"

namespace thimble::render {

/// Returns the number of a whole word: decimal, with an exponent by `e` or, as in Fortran, by `d`;
/// a number too small for a double is 0. Empty for any other word ("1mm", "1,250.5", "0x10"). May
/// be NaN or infinite ("nan", "inf"). Independent of the locale. Real-time: never from the servo
/// thread.
std::optional<double> real_number(std::string_view word);

/// Returns the integer of a whole word; empty for any other word. Real-time: never from the servo
/// thread.
std::optional<std::int64_t> whole_number(std::string_view word);

/// Returns a word for use in a message: in quotes, cut after 24 characters, with `?` for characters
/// that are not printable. Real-time: never from the servo thread.
std::string shown_word(std::string_view word);

/// The words of a text with their lines. Lines end with a line feed, a carriage return or both; `#`
/// hides the rest of its line. The text and the name must outlive it.
class TextWords {
 public:
  /// Reads `text`; errors begin with `name` and the line. With `joins_lines`, a backslash at the
  /// end of a line joins it with the next one.
  TextWords(std::string_view text, const std::string& name, bool joins_lines = false)
      : text_(text), name_(name), joins_lines_(joins_lines) {}

  /// Returns the next word on any line; empty at the end of the text.
  std::string_view next() {
    for (;;) {
      const std::string_view word = next_on_line();
      if (!word.empty() || at_end()) return word;
      next_line();
    }
  }

  /// Returns the next word on this line; empty if there is none.
  std::string_view next_on_line() {
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (is_blank(c)) {
        ++at_;
      } else if (c == '#') {
        skip_line();
      } else if (c == '\\' && joins_here()) {
        ++at_;
        next_line();
      } else {
        break;
      }
    }
    const std::size_t begin = at_;
    while (at_ < text_.size() && !is_blank(text_[at_]) && !is_line_end(text_[at_]) &&
           text_[at_] != '#' && !(text_[at_] == '\\' && joins_here())) {
      ++at_;
    }
    return text_.substr(begin, at_ - begin);
  }

  /// Reads the next line if it is `count`, then numbers below `limit`, as plain digits with single
  /// spaces, and nothing else. Returns false and reads nothing if it has any other form.
  bool next_plain_line(std::uint32_t count, std::uint32_t limit, std::span<std::int32_t> numbers) {
    std::size_t at = at_;
    if (at < text_.size() && text_[at] == '\r') ++at;
    if (at == text_.size() || text_[at] != '\n') return false;
    ++at;
    std::uint32_t number = 0;
    if (!plain_number(at, number) || number != count) return false;
    for (std::int32_t& one : numbers) {
      if (at == text_.size() || text_[at] != ' ') return false;
      ++at;
      if (!plain_number(at, number) || number >= limit) return false;
      one = static_cast<std::int32_t>(number);
    }
    if (at == text_.size() || !is_line_end(text_[at])) return false;
    at_ = at;
    ++line_;
    return true;
  }

  /// Skips the rest of this line; the next word on it is empty.
  void skip_line() {
    while (at_ < text_.size() && !is_line_end(text_[at_])) ++at_;
  }

  /// Skips the rest of this line and its end.
  void next_line() {
    skip_line();
    if (at_end()) return;
    at_ += text_[at_] == '\r' && at_ + 1 < text_.size() && text_[at_ + 1] == '\n' ? 2U : 1U;
    ++line_;
  }

  /// Returns whether the end of the text is reached.
  bool at_end() const { return at_ == text_.size(); }
  /// Returns the number of bytes left.
  std::size_t left() const { return text_.size() - at_; }
  /// Returns the number of this line, from 1.
  std::size_t line() const { return line_; }

  /// Returns an error on this line.
  driver::Error error(const std::string& sentence) const { return error_at(line_, sentence); }
  /// Returns an error on another line.
  driver::Error error_at(std::size_t line, const std::string& sentence) const {
    return {name_ + ":" + std::to_string(line) + ": " + sentence};
  }

 private:
  static bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
  static bool is_line_end(char c) { return c == '\n' || c == '\r'; }
  bool plain_number(std::size_t& at, std::uint32_t& number) const {
    constexpr std::size_t kDigitsMax = 9;  // below 2^32
    const std::size_t begin = at;
    number = 0;
    while (at < text_.size() && text_[at] >= '0' && text_[at] <= '9' && at - begin <= kDigitsMax) {
      number = 10 * number + static_cast<std::uint32_t>(text_[at++] - '0');
    }
    return at > begin && at - begin <= kDigitsMax;
  }
  bool joins_here() const {
    return joins_lines_ && (at_ + 1 == text_.size() || is_line_end(text_[at_ + 1]));
  }

  std::string_view text_;
  const std::string& name_;
  bool joins_lines_;
  std::size_t at_ = 0;
  std::size_t line_ = 1;
};

}  // namespace thimble::render
