#include "mesh/file/text_words.h"

#include <array>
#include <charconv>
#include <system_error>

namespace thimble::render {
namespace {

// The longest word with an exponent by `d`.
constexpr std::size_t kFortranMax = 64;

/// Returns the number of a word such as "-0.0612345": digits with an optional sign and point. Empty
/// for any other word, and for a number with too many digits.
std::optional<double> plain_decimal(std::string_view word) {
  // The digits are an integer below 2^53 and the power of ten is exact, so that their quotient is
  // the nearest double, as from_chars returns it [Clinger].
  constexpr int kDigitsMax = 15;
  constexpr std::array kPowers{1e0, 1e1, 1e2,  1e3,  1e4,  1e5,  1e6,  1e7,
                               1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15};
  const bool negative = word.starts_with('-');
  if (negative) word.remove_prefix(1);
  std::int64_t digits = 0;
  int count = 0, decimals = 0;
  bool point = false;
  for (const char c : word) {
    if (c == '.' && !point) {
      point = true;
    } else if (c >= '0' && c <= '9' && count < kDigitsMax) {
      digits = 10 * digits + (c - '0');
      ++count;
      decimals += point ? 1 : 0;
    } else {
      return std::nullopt;
    }
  }
  if (count == 0) return std::nullopt;
  const double number = static_cast<double>(digits) / kPowers[static_cast<std::size_t>(decimals)];
  return negative ? -number : number;
}

bool starts_number(std::string_view word) {
  return !word.empty() && word[0] != '+' && word[0] != '-';
}

}  // namespace

std::optional<double> real_number(std::string_view word) {
  if (const auto plain = plain_decimal(word)) return plain;
  if (!word.empty() && word[0] == '+') {
    word.remove_prefix(1);
    if (!starts_number(word)) return std::nullopt;
  }
  double number = 0;
  const char* const end = word.data() + word.size();
  const auto [stop, status] = std::from_chars(word.data(), end, number);
  if (status == std::errc() && stop == end) return number;
  if (status == std::errc::result_out_of_range && stop == end) {
    // Too small is 0; too large is not valid in a mesh.
    const std::size_t exponent = word.find_first_of("eE");
    const bool small = exponent + 1 < word.size() && word[exponent + 1] == '-';
    return small && exponent != std::string_view::npos ? std::optional<double>(0) : std::nullopt;
  }
  if (status != std::errc() || (*stop != 'd' && *stop != 'D') || word.size() > kFortranMax) {
    return std::nullopt;
  }
  std::string with_e(word);
  with_e[static_cast<std::size_t>(stop - word.data())] = 'e';
  return real_number(with_e);
}

std::optional<std::int64_t> whole_number(std::string_view word) {
  if (!word.empty() && word[0] == '+') {
    word.remove_prefix(1);
    if (!starts_number(word)) return std::nullopt;
  }
  std::int64_t number = 0;
  const auto [stop, status] = std::from_chars(word.data(), word.data() + word.size(), number);
  if (status != std::errc() || stop != word.data() + word.size()) return std::nullopt;
  return number;
}

std::string shown_word(std::string_view word) {
  constexpr std::size_t kShown = 24;
  std::string shown = "\"";
  for (const char c : word.substr(0, kShown)) shown += (c > ' ' && c < 127) ? c : '?';
  return shown + (word.size() > kShown ? "...\"" : "\"");
}

}  // namespace thimble::render
