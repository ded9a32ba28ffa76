#include "arm/wire_bytes.h"

#include <algorithm>
#include <bit>
#include <charconv>
#include <string>

namespace thimble::scene {
namespace {

driver::Error unknown(std::string_view word) {
  return driver::Error{
      "expected bytes such as aa 55 'text' u16:500 f32:0.5, separated by spaces, found \"" +
      std::string(word) + '"'};
}

void put_number(std::uint64_t bits, std::size_t count, bool big_endian, WireBytes& into) {
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = big_endian ? count - 1 - i : i;
    into.bytes.push_back(static_cast<std::byte>(bits >> (8 * place)));
    into.any.push_back(false);
  }
}

/// Parses "u16:500"; returns false if it is no such number.
bool put_typed(std::string_view word, bool big_endian, WireBytes& into) {
  const std::size_t colon = word.find(':');
  if (colon == std::string_view::npos || colon < 2) return false;
  const std::string_view type = word.substr(0, colon), digits = word.substr(colon + 1);
  const char* const first = digits.data();
  const char* const last = first + digits.size();
  const auto whole = [&](const std::from_chars_result& parsed) {
    return parsed.ec == std::errc() && parsed.ptr == last;
  };
  if (type == "f32") {
    float value = 0;
    if (!whole(std::from_chars(first, last, value))) return false;
    put_number(std::bit_cast<std::uint32_t>(value), 4, big_endian, into);
    return true;
  }
  const bool is_signed = type[0] == 'i';
  const std::string_view width = type.substr(1);
  const std::size_t bits = width == "8" ? 8 : width == "16" ? 16 : width == "32" ? 32 : 0;
  if (bits == 0 || (!is_signed && type[0] != 'u')) return false;
  std::int64_t value = 0;
  if (!whole(std::from_chars(first, last, value))) return false;
  const std::int64_t max = (std::int64_t{1} << (is_signed ? bits - 1 : bits)) - 1;
  if (value > max || value < (is_signed ? -max - 1 : 0)) return false;
  put_number(static_cast<std::uint64_t>(value), bits / 8, big_endian, into);
  return true;
}

}  // namespace

std::optional<std::uint32_t> parse_hex(std::string_view text, std::uint32_t max) {
  if (text.starts_with("0x")) text.remove_prefix(2);
  std::uint32_t value = 0;
  const auto [after, failure] = std::from_chars(text.data(), text.data() + text.size(), value, 16);
  if (text.empty() || failure != std::errc() || after != text.data() + text.size()) {
    return std::nullopt;
  }
  if (value > max) return std::nullopt;
  return value;
}

driver::Result<WireBytes> parse_wire_bytes(std::string_view text, bool big_endian) {
  WireBytes result;
  while (true) {
    const std::size_t first = text.find_first_not_of(' ');
    if (first == std::string_view::npos) return result;
    text.remove_prefix(first);
    if (text[0] == '\'') {
      const std::size_t end = text.find('\'', 1);
      if (end == std::string_view::npos) return unknown(text);
      for (const char c : text.substr(1, end - 1)) {
        result.bytes.push_back(static_cast<std::byte>(c));
        result.any.push_back(false);
      }
      text.remove_prefix(end + 1);
      continue;
    }
    const std::string_view word = text.substr(0, std::min(text.find(' '), text.size()));
    text.remove_prefix(word.size());
    if (word == "??") {
      result.bytes.push_back(std::byte{0});
      result.any.push_back(true);
    } else if (const auto byte = parse_hex(word, 0xff); byte && word.size() == 2) {
      result.bytes.push_back(static_cast<std::byte>(*byte));
      result.any.push_back(false);
    } else if (!put_typed(word, big_endian, result)) {
      return unknown(word);
    }
  }
}

}  // namespace thimble::scene
