#include "report/html/page_block.h"

#include <zlib.h>

#include <bit>
#include <new>

namespace thimble::report {

static_assert(std::endian::native == std::endian::little, "a page's numbers are little-endian");

void PageBlock::append(const std::string& name, const char* type, const void* data,
                       std::size_t count, std::size_t size) {
  bytes_.resize((bytes_.size() + 7) / 8 * 8);
  arrays_[name] = {{"type", type}, {"offset", bytes_.size()}, {"count", count}};
  const auto* first = static_cast<const std::uint8_t*>(data);
  if (count > 0) bytes_.insert(bytes_.end(), first, first + count * size);
}

void PageBlock::add(const std::string& name, std::span<const double> numbers) {
  append(name, "f64", numbers.data(), numbers.size(), sizeof(double));
}
void PageBlock::add(const std::string& name, std::span<const float> numbers) {
  append(name, "f32", numbers.data(), numbers.size(), sizeof(float));
}
void PageBlock::add(const std::string& name, std::span<const std::uint32_t> numbers) {
  append(name, "u32", numbers.data(), numbers.size(), sizeof(std::uint32_t));
}
void PageBlock::add(const std::string& name, std::span<const std::uint16_t> numbers) {
  append(name, "u16", numbers.data(), numbers.size(), sizeof(std::uint16_t));
}
void PageBlock::add(const std::string& name, std::span<const std::int16_t> numbers) {
  append(name, "i16", numbers.data(), numbers.size(), sizeof(std::int16_t));
}
void PageBlock::add(const std::string& name, std::span<const std::uint8_t> numbers) {
  append(name, "u8", numbers.data(), numbers.size(), 1);
}

std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes) {
  uLongf size = compressBound(bytes.size());
  std::vector<std::uint8_t> packed(size);
  // Without memory for zlib's window there is none for the page either.
  if (compress2(packed.data(), &size, bytes.data(), bytes.size(), Z_DEFAULT_COMPRESSION) != Z_OK) {
    throw std::bad_alloc();
  }
  packed.resize(size);
  return packed;
}

std::string base64(std::span<const std::uint8_t> bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t left = bytes.size() - i;
    const std::uint32_t three = std::uint32_t{bytes[i]} << 16 |
                                (left > 1 ? std::uint32_t{bytes[i + 1]} << 8 : 0) |
                                (left > 2 ? std::uint32_t{bytes[i + 2]} : 0);
    text += kDigits[three >> 18 & 63];
    text += kDigits[three >> 12 & 63];
    text += left > 1 ? kDigits[three >> 6 & 63] : '=';
    text += left > 2 ? kDigits[three & 63] : '=';
  }
  return text;
}

std::string html_text(std::string_view text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      case '\'':
        safe += "&#39;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

}  // namespace thimble::report
