#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace thimble::report {

/// The binary data of a page: consecutive arrays of numbers, little-endian, each at a multiple of 8
/// bytes, so that a browser can use them without copying. Real-time: never from the servo thread.
class PageBlock {
 public:
  /// Adds an array with a unique name. Its type on the page is one of JavaScript's typed arrays:
  /// f64, f32, u32, u16, i16 or u8.
  void add(const std::string& name, std::span<const double> numbers);
  void add(const std::string& name, std::span<const float> numbers);          ///< As above.
  void add(const std::string& name, std::span<const std::uint32_t> numbers);  ///< As above.
  void add(const std::string& name, std::span<const std::uint16_t> numbers);  ///< As above.
  void add(const std::string& name, std::span<const std::int16_t> numbers);   ///< As above.
  void add(const std::string& name, std::span<const std::uint8_t> numbers);   ///< As above.

  /// Returns the position of each array: {"NAME": {"type", "offset", "count"}}, offsets in bytes.
  const nlohmann::ordered_json& arrays() const noexcept { return arrays_; }
  /// Returns all bytes.
  std::span<const std::uint8_t> bytes() const noexcept { return bytes_; }

 private:
  void append(const std::string& name, const char* type, const void* data, std::size_t count,
              std::size_t size);

  nlohmann::ordered_json arrays_ = nlohmann::ordered_json::object();
  std::vector<std::uint8_t> bytes_;
};

/// Returns bytes in the zlib format (RFC 1950), which parts/inflate.js reads. Pages of shipped
/// scenes are 30 to 45 % smaller by it. [measured]
std::vector<std::uint8_t> deflated(std::span<const std::uint8_t> bytes);

/// Returns bytes as base64 (RFC 4648), without line breaks.
std::string base64(std::span<const std::uint8_t> bytes);

/// Escapes text for HTML, between tags or in a quoted attribute.
std::string html_text(std::string_view text);

}  // namespace thimble::report
