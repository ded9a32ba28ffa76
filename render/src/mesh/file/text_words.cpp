#include "mesh/file/text_words.h"

#include <charconv>
#include <system_error>

namespace thimble::render {
namespace {

// The longest word with an exponent by `d`.
constexpr std::size_t kFortranMax = 64;

bool starts_number(std::string_view word) {
  return !word.empty() && word[0] != '+' && word[0] != '-';
}

}  // namespace

std::optional<double> real_number(std::string_view word) {
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
